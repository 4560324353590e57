/// What is minimised or balanced on a rod, and its derivatives in the unknowns.
#pragma once

#include <span>

#include "wunderlich/baseline/rod/contact.hpp"
#include "wunderlich/baseline/rod/energy.hpp"
#include "wunderlich/baseline/rod/followers.hpp"
#include "wunderlich/baseline/rod/holds.hpp"
#include "wunderlich/math/banded.hpp"

namespace wunderlich::baseline::rod {

/// What there is beside the elastic energy: dead loads, springs that stand for a step of time, a barrier; and loads
/// that have no potential.
struct Objective {
  std::vector<Vec3> force;                  ///< (segments + 1) [N]
  std::vector<Mat3> node_tie;               ///< (segments + 1) stiffness [N/m]; empty in equilibria
  std::vector<Vec3> node_goal;              ///< (segments + 1) [m]
  std::vector<double> edge_tie, edge_goal;  ///< (segments) [N m], [rad]
  Solids solids;
  std::vector<Follower> followers;
  bool has_potential() const { return followers.empty(); }
};

/// At a state, of all that has a potential [J].
double value(const Rod& rod, const Objective& objective, const State& state);

/// What is out of balance, in the unknowns, and its derivative.
struct System {
  math::BandedMatrix hessian;  ///< of the value
  /// One entry of the derivative of loads without potential, to be added to the Hessian's.
  struct Entry {
    int row = 0, column = 0;
    double value = 0;
  };
  std::vector<Entry> follower;
  std::vector<double> gradient;  ///< of the value, less the loads without potential [N, N m]
};

/// Derivatives at a state. The increments that supports give are taken to first order: their part of the derivative
/// times them is added to the gradient, so that a Newton step answers to them. Where `stress` is not empty, the
/// Hessian has these turn with the rod, not those that strains give: tensions of the edges, then five of each node.
void assemble(const Rod& rod, const Objective& objective, const State& state, const Unknowns& unknowns, System& system,
              std::span<const double> stress = {});

/// What steps are measured by: lengths, for turns of sections times their radius of gyration squared.
void find_metric(const Rod& rod, const Unknowns& unknowns, std::vector<double>& metric);

/// Increments of all coordinates from those of the unknowns and a share of what supports give.
void expand(const Unknowns& unknowns, const std::vector<double>& step, double given, std::vector<double>& increment);

/// Largest displacement over the length, or turn; and the share of the increment that bends no edge too much.
struct Size {
  double step = 0, share = 1;
};
Size size_of(const Rod& rod, const std::vector<double>& increment);

/// Exchanges what `move` changes.
void swap_shapes(State& a, State& b);

}  // namespace wunderlich::baseline::rod
