/// Joint coordinates: the ribbon as the chain of planar trapezoids that its constraints make it.
///
/// What is free in such a chain is the pose of its base and (kappa, eta) at each hinge. Positions and frames
/// follow by forward kinematics, so length, parallel, binormal and torsion match hold to rounding.
#pragma once

#include <vector>

#include "wunderlich/geometry/joint.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::geometry {

struct Chain {
  Pose base;                  ///< node 0 with the start node's frame if clamped, else the first segment's
  std::vector<double> kappa;  ///< (segments + 1), 0 where fold_length is 0 [1/m]
  std::vector<double> eta;    ///< (segments + 1); a loop's first entries mirror its last ones when it is closed
};

/// Positions and frames of a chain; entry `segments` of the frames is the frame beyond the last hinge: the end
/// node's own, or for a loop the first segment seen across the seam.
struct Kinematics {
  std::vector<Vec3> r;      ///< (segments + 1)
  std::vector<Quat> q;      ///< (segments + 1)
  std::vector<Mat3> frame;  ///< (segments + 1) the same as matrices

  /// Nodes 4b ... 4b + 3 in entry b; beyond the last node it is repeated.
  std::vector<Fold<math::Four>> fold;
};

/// Positions and frames along a chain, from its base on; `kinematics` is resized as needed.
void forward_kinematics(const Ribbon& ribbon, const Chain& chain, Kinematics& kinematics);

/// The paper's coordinates of a chain; velocities zero.
State state_of(const Ribbon& ribbon, const Chain& chain, double time);

/// Joint coordinates nearest to a state (exact if the state satisfies the constraints).
Chain chain_of(const Ribbon& ribbon, const State& state);

/// A flat straight strip with its base at `base`.
Chain straight_chain(const Ribbon& ribbon, const Pose& base);

/// Length that kappa at a node is taken over: its hinge's, and at node 0 of a loop the seam hinge's, which turns
/// the frame at the last node only but shares its energy between the first and the last link.
inline double fold_length(const Ribbon& ribbon, std::size_t node) {
  return ribbon.is_loop() && node == 0 ? ribbon.hinge_length.back() : ribbon.hinge_length[node];
}

/// The same for four nodes.
inline math::Four fold_lengths(const Ribbon& ribbon, std::size_t first) {
  const math::Four h = math::load(ribbon.hinge_length, first);
  return first > 0 ? h : math::Four{fold_length(ribbon, 0), h[1], h[2], h[3]};
}

/// May kappa, eta at this node vary: kappa where there is a hinge, eta everywhere but at the ends of an open
/// strip whose ends are cut square, and at node 0 where there is one.
bool kappa_is_free(const Ribbon& ribbon, int node);
bool eta_is_free(const Ribbon& ribbon, int node);

}  // namespace wunderlich::geometry
