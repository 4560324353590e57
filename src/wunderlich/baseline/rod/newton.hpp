/// Newton's method on a rod: down to a minimum where all loads have a potential, else to a balance of forces.
#pragma once

#include "wunderlich/baseline/rod/system.hpp"

namespace wunderlich::baseline::rod {

/// Of `minimise`; `balance` always predicts, and minds no saddles.
struct Options {
  /// Supports that move carry the rest along as the linearised rod would follow, if that takes less energy than leaving
  /// it where it is.
  bool predict = true;
  bool leave_saddles = true;  ///< go on from a stationary point of the energy that has negative modes
};

/// Steps are small enough below this: displacement / length, turn of a section [rad].
constexpr double kLastStep = 1e-8;

enum class Outcome { converged, iteration_limit, line_search_failed, indefinite, saddle, stalled, singular, blocked };

struct Report {
  Outcome outcome = Outcome::iteration_limit;
  int iterations = 0;
  int negative_modes = 0;  ///< of the Hessian where it stopped; not counted where loads have no potential
  bool converged() const { return outcome == Outcome::converged; }
};
const char* outcome_name(Outcome outcome);

/// Buffers; no allocation once they have their size.
struct Workspace {
  Unknowns unknowns;
  Objective objective;
  System system, trial_system;
  math::BandedMatrix factors;
  math::GeneralBanded jacobian;
  std::vector<double> step, increment, metric, mode;
  std::vector<double> stress, stress_step, trial_stress, defect, rest;  ///< of a balance
  State trial, other;
};

/// Moves the supports of `work.unknowns` and finds a minimum of `work.objective` near the state, which changes only if
/// the method converges; its velocities and time do not. Banded factors of the exact Hessian, shifted where it has
/// negative modes, and a search along the step that lowers the value. All loads must have a potential.
Report minimise(const Rod& rod, const Options& options, State& state, Workspace& work);

/// The same for any loads: finds where forces balance, a minimum or not. Newton's steps with the exact derivative,
/// which need not be symmetric, and stresses as unknowns beside positions: edges that turn lengthen to second order,
/// and stretching is so stiff that the forces of that would leave short steps only.   @eq Magisano2017 Steps are
/// shortened until the step that would come next is shorter than this one.   @eq Deuflhard2011
Report balance(const Rod& rod, State& state, Workspace& work);

}  // namespace wunderlich::baseline::rod
