/// What moves: exactly what is needed to go on, the paper's generalized coordinates.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/geometry/ribbon.hpp"

namespace wunderlich::geometry {

/// @eq Shen2015:7
struct State {
  double time = 0;
  std::vector<Vec3> r;           ///< (segments + 1) node positions [m]
  std::vector<Vec3> r_dot;       ///< (segments + 1) node velocities [m/s]
  std::vector<Quat> q;           ///< (segments) unit quaternions of the segment frames
  std::vector<double> eta;       ///< (segments + 1) ruling slopes
  std::array<Quat, 2> end_frame{Quat::Identity(), Quat::Identity()};
  ///< frames of the two end nodes: prescribed where clamped, else those of the neighbouring segments
};

/// The undeformed strip: along +x from the origin with d1 = +z, d2 = -y, d3 = +x.
State straight_state(const Ribbon& ribbon);

/// Strains of a state; by the quaternion logarithm (rotation vector over the hinge length).
struct Strains {
  std::vector<double> gamma;          ///< (segments + 1) binormal bending, must vanish [1/m]
  std::vector<double> kappa;          ///< (segments + 1) curvature [1/m]
  std::vector<double> tau;            ///< (segments + 1) torsion [1/m]
  std::vector<double> eta_prime;      ///< (segments) [1/m]
  std::vector<double> ruling_ratio;   ///< (segments) x = w eta'/2
};

/// @eq Shen2015:9. A clamped end's strain is that of its half cell; a free end's is 0; node 0 of a loop
/// shows the seam hinge of the last node, seen from the other side.
Strains strains(const Ribbon& ribbon, const State& state);

/// The frame at a node: the mean rotation of its neighbours (the end frame at an end).
Quat node_frame(const Ribbon& ribbon, const State& state, int node);

}  // namespace wunderlich::geometry
