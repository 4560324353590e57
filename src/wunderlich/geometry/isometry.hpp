/// How far the surface of a strip is from an isometry of the flat one: a measure that is the same for every model.
#pragma once

#include <vector>

#include "wunderlich/base/comparison.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::geometry {

/// A strip's surface as a grid of material points: column i of `along + 1`, row j of `across + 1`, at i (across + 1) +
/// j; rows run along the strip, the first and the last are its rims. Between its points it is two triangles a cell.
struct StripGrid {
  int along = 0;
  int across = 0;
  std::vector<Vec3> points;  ///< [m]
  std::vector<Vec2> flat;    ///< where they lie in the flat pattern: x along, y across [m]
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (across + 1) + j); }
};

/// Compares lengths and areas of the grid with those of its flat pattern.
IsometryErrors isometry_errors(const StripGrid& grid);

/// The ribbon's own facets, their rulings cut into `across` parts.   @eq Shen2015:1
StripGrid facet_grid(const Ribbon& ribbon, const State& state, int across);

}  // namespace wunderlich::geometry
