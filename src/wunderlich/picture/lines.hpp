/// Rims and rulings.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::picture {

using Line = std::array<Vec3, 2>;  // [m]

/// Edges of one triangle only: the rims, and the ends of strips that are not joined. As pairs of points of the surface.
std::vector<std::array<int, 2>> rim_edges(const Mesh& surface, const std::vector<FlatPattern>& strips);

/// The ruling of each node.
std::vector<Line> rulings_of(const Frame& frame, const std::vector<FlatPattern>& strips);

}  // namespace wunderlich::picture
