/// The ruled surface of a state: exact trapezoids for measurement, a smooth mesh for rendering.
#pragma once

#include "wunderlich/base/frame.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::geometry {

/// Area of the discrete surface: one quadrilateral between adjacent rulings per segment, or the two triangles
/// where the rulings meet inside the strip (|x| >= 1). For an exact isometry it is length * width [m^2].
/// @eq Shen2015:6.1
double surface_area(const Ribbon& ribbon, const State& state);

/// |area - length * width| / (length * width)
double area_error(const Ribbon& ribbon, const State& state);

/// The mesh of §6.1, points r + v ruling (@eq Shen2015:1): cubic spline through the centerline, linear eta and frame;
/// `subdivision` strips a segment along the length, `across` quads over the width. Connectivity depends on these
/// numbers only.
Mesh render_mesh(const Ribbon& ribbon, const State& state, int subdivision, int across);

/// Nodes with mean frames and strains, as in `centerline.csv`.
std::vector<CenterlineSample> centerline(const Ribbon& ribbon, const State& state);

/// The strip unrolled: each node's ruling in the flat strip and the fold about it.
FlatPattern flat_pattern(const Ribbon& ribbon, const State& state);

}  // namespace wunderlich::geometry
