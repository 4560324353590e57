/// The strip itself: what a user states, and the immutable discrete ribbon that follows from it.
///
/// Index families, and only these: node i in [0, segments], segment s in [0, segments).
/// Segment s joins nodes s and s + 1. The hinge at node i joins segments i - 1 and i; hinge quantities
/// are therefore stored by node. A loop repeats its first node as node `segments`, seen across the seam.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::geometry {

/// Whether the two ends of the strip are joined.
enum class Closure { open, loop };

/// What a user states of a strip.
struct RibbonSpec {
  double length = 1;   ///< [m]
  double width = 0.1;  ///< full width [m]
  int segments = 50;
  double bending_stiffness = 1;  ///< D [N m]
  double area_density = 1;       ///< rho [kg/m^2]
  Closure closure = Closure::open;
  int half_twists = 0;            ///< loops: turns of pi of the frame about +d3 as u grows
  std::array<bool, 2> clamped{};  ///< open strips: does the start, the end have a frame of its own,
                                  ///< prescribed by a clamp or turned by a torque
  bool free_rulings = false;      ///< open strips: leave eta free at the ends instead of 0
  std::vector<double> spacing;    ///< relative segment lengths; empty means uniform
};

/// The discrete ribbon: constant through a run.
struct Ribbon {
  double length = 0;
  double width = 0;
  double bending_stiffness = 0;
  double area_density = 0;
  int segments = 0;
  Closure closure = Closure::open;
  int half_twists = 0;
  std::array<bool, 2> clamped{};
  bool free_rulings = false;
  std::vector<double> rest_length;   ///< (segments) [m]
  std::vector<double> node_u;        ///< (segments + 1) arc length of each node [m]
  std::vector<double> hinge_length;  ///< (segments + 1) length a hinge stands for [m]: the mean of its
                                     ///< two segments, half a segment at an end with a frame, 0 at a free end
                                     ///< and at node 0 of a loop (its hinge is the seam's, at the last node)
  std::vector<double> node_mass;     ///< (segments + 1) [kg]; a loop's seam mass stands at node 0

  int node_count() const { return segments + 1; }
  bool is_loop() const { return closure == Closure::loop; }
  /// +1, or -1 where passing the seam reverses the surface (odd half twists): kappa, eta, eta' change sign.
  double seam_sign() const { return half_twists % 2 == 0 ? 1.0 : -1.0; }
};

/// Builds the discrete ribbon. The spec must be valid (the scene reader checks it); asserts otherwise.
Ribbon make_ribbon(const RibbonSpec& spec);

/// Turns a frame across the seam: half_twists half turns about d3.
Quat across_seam(const Ribbon& ribbon, const Quat& frame);

}  // namespace wunderlich::geometry
