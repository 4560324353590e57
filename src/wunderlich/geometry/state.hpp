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
  std::vector<Vec3> r;      ///< (segments + 1) node positions [m]
  std::vector<Vec3> r_dot;  ///< (segments + 1) node velocities [m/s]
  std::vector<Quat> q;      ///< (segments) unit quaternions of the segment frames
  std::vector<double> eta;  ///< (segments + 1) ruling slopes
  std::array<Quat, 2> end_frame{Quat::Identity(), Quat::Identity()};
  ///< frames of the two end nodes: prescribed where clamped, else those of the neighbouring segments
};

/// The undeformed strip: along +x from the origin with d1 = +z, d2 = -y, d3 = +x.
State straight_state(const Ribbon& ribbon);

/// How the relative rotation p = conj(q^a) q^b of two frames becomes a strain over a hinge of length h.
enum class StrainMeasure {
  logarithm,  ///< log(p)/h, the rotation vector: exact for the ring, monotone in the fold angle
  printed,    ///< (2/h) vec(p), as the paper prints it   @eq Shen2015:10
};

/// Strains of a state, each over its hinge's length.
struct Strains {
  std::vector<double> gamma;         ///< (segments + 1) binormal bending, must vanish [1/m]
  std::vector<double> kappa;         ///< (segments + 1) curvature [1/m]
  std::vector<double> tau;           ///< (segments + 1) torsion [1/m]
  std::vector<double> eta_prime;     ///< (segments) [1/m]
  std::vector<double> ruling_ratio;  ///< (segments) x = w eta'/2; rulings meet from 1 on   @eq Shen2015:2
};

/// (gamma, kappa, tau) of two neighbouring frames, body components of the Darboux vector [1/m].
/// The signs of the quaternions do not matter.   @eq Shen2015:9
Vec3 hinge_strain(const Quat& before, const Quat& after, double hinge_length, StrainMeasure measure);

/// The two frames that the hinge of a node joins: a clamped end's frame stands in for the missing segment,
/// and segment 0 seen across the seam follows the last segment of a loop (hinge `segments`).
/// The node must carry a hinge (hinge_length > 0).
std::array<Quat, 2> hinge_frames(const Ribbon& ribbon, const State& state, int node);

/// @eq Shen2015:9. A clamped end's strain is that of its half cell; a free end's is 0; node 0 of a loop
/// shows the seam hinge of the last node, seen from the other side: a half turn of the frames about d3 takes
/// (gamma, kappa, tau) to (-gamma, -kappa, +tau).
Strains strains(const Ribbon& ribbon, const State& state, StrainMeasure measure = StrainMeasure::logarithm);

/// The frame at a node, interpolated along the shorter rotation between the middles of its two segments (their
/// mean for equal segments). At an end the end frame if clamped, else that of the end segment. The frames at
/// the two ends of a loop are one, seen from either side of the seam.
Quat node_frame(const Ribbon& ribbon, const State& state, int node);

}  // namespace wunderlich::geometry
