/// Newton's method on a rod: banded factorisation of the exact Hessian, shifted where it has negative modes.
#pragma once

#include "wunderlich/baseline/rod/contact.hpp"
#include "wunderlich/baseline/rod/energy.hpp"
#include "wunderlich/baseline/rod/holds.hpp"
#include "wunderlich/math/banded.hpp"

namespace wunderlich::baseline::rod {

/// What is minimised beside the elastic energy: dead loads, springs that stand for a step of time, a barrier.
struct Objective {
  std::vector<Vec3> force;                  ///< (segments + 1) [N]
  std::vector<double> moment;               ///< (segments) on the turn of an edge [N m]
  std::vector<Mat3> node_tie;               ///< (segments + 1) stiffness [N/m]; empty in equilibria
  std::vector<Vec3> node_goal;              ///< (segments + 1) [m]
  std::vector<double> edge_tie, edge_goal;  ///< (segments) [N m], [rad]
  Solids solids;
};

/// At a state [J].
double value(const Rod& rod, const Objective& objective, const State& state);

struct Options {
  double tolerance = 1e-8;  ///< on the last step: displacement / length, turn of a section [rad]
  int max_iterations = 500;
  bool predict = true;        ///< supports that move carry the rest along as the linearised rod would follow, if that
                              ///< takes less energy than leaving it where it is
  bool leave_saddles = true;  ///< go on from a stationary point that has negative modes
};

enum class Outcome { converged, iteration_limit, line_search_failed, blocked };

struct Report {
  Outcome outcome = Outcome::iteration_limit;
  int iterations = 0;
  int factorisations = 0;
  int kicks = 0;           ///< times it left a stationary point that was no minimum
  int negative_modes = 0;  ///< of the Hessian where it stopped
  double last_step = 0;
  double gradient = 0;  ///< norm by the unknowns where it stopped [N, N m]
  bool converged() const { return outcome == Outcome::converged; }
};
const char* outcome_name(Outcome outcome);

/// Derivatives in the unknowns.
struct System {
  math::BandedMatrix hessian;
  std::vector<double> gradient;
};

/// Buffers; no allocation once they have their size.
struct Workspace {
  Unknowns unknowns;
  Objective objective;
  System system;
  math::BandedMatrix factors;
  std::vector<double> step, increment, metric, mode;
  State trial, other;
};

/// Gradient and Hessian at a state. The increments that supports give are taken to first order: their part of the
/// Hessian times them is added to the gradient, so that a Newton step answers to them.
void assemble(const Rod& rod, const Objective& objective, const State& state, const Unknowns& unknowns, System& system);

/// Moves the supports of `work.unknowns` and finds a minimum of `work.objective` near the state, which changes only if
/// the method converges; its velocities and time do not.
Report minimise(const Rod& rod, const Options& options, State& state, Workspace& work);

}  // namespace wunderlich::baseline::rod
