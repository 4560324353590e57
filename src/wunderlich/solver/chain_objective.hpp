/// The constrained objective of one equilibrium (or one proximal step) in joint coordinates, and its
/// linearisation for the chain sweep.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/chain_sweep.hpp"
#include "wunderlich/solver/touching.hpp"

namespace wunderlich::solver {

/// A prescribed pose at one load parameter: a support with its target.
struct Hold {
  int node = 0;                                    ///< link whose node and frame are held; N: the end frame
  std::array<bool, 3> position{true, true, true};  ///< world axes
  constraint::Orientation orientation = constraint::Orientation::full;
  Pose target;           ///< about_tangent: the frame to be transported and turned
  bool on_base = false;  ///< the frame held is the start node's own (only for about_tangent; node 0)
  int end = -1;          ///< end of the strip (0, 1) whose support this is; -1: none
};

/// A force and torque on the pose of one link (N: the end frame, -1: the base, the start node's own frame).
struct PointLoad {
  int node = 0;
  constraint::LoadFrame frame = constraint::LoadFrame::space;
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

/// A spring between the facet of one segment and an anchor: half of the sum of weight_jk e_j . e_k, e the differences
/// in its middle, its tangent d3 and its width direction d2.
struct FacetTie {
  Mat3 weight = Mat3::Zero();  ///< symmetric
  Mat3 anchor = Mat3::Zero();  ///< middle, d3, d2 as columns
};

/// One more such spring, on the facet of link `node`: a hand.
struct GripTie {
  int node = 0;
  FacetTie tie;
};

/// Everything that is minimised over a chain: elastic energy + barrier - loads + ties, subject to the holds and, for
/// loops, the closure. Ties are a proximal term in statics and the inertia of a step in dynamics.
struct ChainProblem {
  energy::Model model;
  double barrier = 1e-6;                    ///< e1: e1 D sum over segments of (l_s/w) (-ln(1 - x^2))
  double wall = 0;                          ///< 1 - x^2 from which on the barrier is a wall; 0: nowhere
  std::vector<Vec3> force;                  ///< (segments + 1) dead force on each node [N]
  std::vector<PointLoad> loads;             ///< sorted by decreasing node
  std::vector<double> tie;                  ///< (segments + 1) or none: (tie/2) |r - anchor|^2 of each node [N/m]
  std::vector<Vec3> anchor;                 ///< (segments + 1) or none
  std::vector<double> turn_tie;             ///< (segments) or none: (tie/2) |d2 - anchor|^2 of each segment [N m]
  std::vector<Vec3> turn_anchor;            ///< (segments) or none
  std::vector<FacetTie> facets;             ///< (segments) or none
  std::vector<GripTie> grips;               ///< in any order
  double viscosity = 0;                     ///< times D w h/2 (g - g before)^2 of each hinge, g its bending
  const geometry::Chain* before = nullptr;  ///< where that bending is taken from, if the viscosity is not 0
  ContactProblem contact;                   ///< solids that the strip stays out of
  SelfContact self;                  ///< and how it stays out of itself; in a step in time all strips do so together
  std::vector<Hold> holds;           ///< sorted by decreasing node
  bool closed = false;               ///< the loop's closure is a constraint
  std::array<bool, 6> base_fixed{};  ///< position and rotation of the base
  Touchable touchable() const { return {contact, self}; }
};

/// Number of constraint rows: the closure's first, then those of each hold in turn.
std::size_t row_count(const Hold& hold);
std::size_t row_count(const ChainProblem& problem);

/// Elastic energy with and without barrier, and everything else that is minimised.
struct ObjectiveValue {
  double elastic = 0;
  double barrier = 0;
  double ties = 0;
  double loads = 0;     ///< minus their work since the reference
  double contact = 0;   ///< of its barrier; `objective` leaves it out
  double friction = 0;  ///< as well
  double total() const { return elastic + barrier + ties + loads + contact + friction; }
};

/// `reference`: frames that torques are measured from (a torque has no potential; its work is taken to first
/// order from the iterate's frames).
ObjectiveValue objective(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
                         const geometry::Kinematics& kinematics, const geometry::Kinematics& reference);

/// Residuals of the constraint rows, largest |w eta'/2| < 1 assumed.
void constraint_residuals(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
                          const geometry::Kinematics& kinematics, std::vector<double>& residuals);

/// Fills `system` around the chain; `multipliers` are the current ones, one a row, `touching` what the chain touches.
void linearise(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
               const geometry::Kinematics& kinematics, const std::vector<double>& multipliers, const Touching& touching,
               math::ChainSystem& system);

/// Takes the Hessian of `system` along straight lines in curvature and torsion, kappa and kappa eta, for the step. In
/// these coordinates the bending energy is convex for every eta, in kappa and eta only for |eta| < 0.45, and fold
/// angles are nearly linear: far from the minimum the step is a better one, at the minimum the same. Where the strip is
/// flat eta itself is the coordinate.
void use_torsion_chart(const geometry::Ribbon& ribbon, const geometry::Chain& chain, math::ChainSystem& system);

}  // namespace wunderlich::solver
