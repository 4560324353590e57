#include "wunderlich/geometry/isometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wunderlich::geometry {

namespace {

/// Keeps the value with the larger magnitude, with its sign.
void keep_larger(double value, double& largest) {
  if (!(std::abs(value) <= std::abs(largest))) largest = value;
}

/// Adds a triangle's areas; looks at its diagonal lines.
void look_at(const StripGrid& grid, const std::array<std::size_t, 3>& corner, double& area, double& flat_area,
             double& diagonal) {
  Eigen::Matrix<double, 3, 2> edges;
  Mat2 flat_edges;
  for (int k = 0; k < 2; ++k) {
    const std::size_t to = corner[static_cast<std::size_t>(k) + 1];
    edges.col(k) = grid.points[to] - grid.points[corner[0]];
    flat_edges.col(k) = grid.flat[to] - grid.flat[corner[0]];
  }
  area += 0.5 * edges.col(0).cross(edges.col(1)).norm();
  flat_area += 0.5 * std::abs(flat_edges.determinant());
  // Facets whose rulings nearly meet have triangles next to nothing at one end: their shape is rounding.
  if (!(std::abs(flat_edges.determinant()) > 1e-9 * flat_edges.squaredNorm())) return;
  const Eigen::Matrix<double, 3, 2> gradient = edges * flat_edges.inverse();
  for (const double sign : {-1.0, 1.0}) {
    keep_larger((gradient * Vec2(std::sqrt(0.5), sign * std::sqrt(0.5))).norm() - 1, diagonal);
  }
}

double rim_error(const StripGrid& grid, int row) {
  double length = 0, flat = 0;
  for (int i = 0; i < grid.along; ++i) {
    length += (grid.points[grid.index(i + 1, row)] - grid.points[grid.index(i, row)]).norm();
    flat += (grid.flat[grid.index(i + 1, row)] - grid.flat[grid.index(i, row)]).norm();
  }
  return length / flat - 1;
}

}  // namespace

IsometryErrors isometry_errors(const StripGrid& grid) {
  IsometryErrors errors;
  double area = 0, flat = 0;
  for (int i = 0; i < grid.along; ++i) {
    for (int j = 0; j < grid.across; ++j) {
      const std::size_t a = grid.index(i, j), b = grid.index(i, j + 1);
      const std::size_t c = grid.index(i + 1, j), d = grid.index(i + 1, j + 1);
      look_at(grid, {a, b, c}, area, flat, errors.diagonal);
      look_at(grid, {d, c, b}, area, flat, errors.diagonal);
    }
  }
  errors.area = area / flat - 1;
  for (const int row : {0, grid.across}) keep_larger(rim_error(grid, row), errors.rim);
  return errors;
}

StripGrid facet_grid(const Ribbon& ribbon, const State& state, int across) {
  StripGrid grid{ribbon.segments, across, {}, {}};
  for (int i = 0; i <= ribbon.segments; ++i) {
    // Facets on both sides of a ruling have it in common.
    const auto node = static_cast<std::size_t>(i);
    const Mat3 frame = state.q[std::min(node, state.q.size() - 1)].toRotationMatrix();
    const Vec3 ruling = frame.col(1) + state.eta[node] * frame.col(2);
    for (int j = 0; j <= across; ++j) {
      const double v = ribbon.width * (static_cast<double>(j) / across - 0.5);
      grid.points.push_back(state.r[node] + v * ruling);
      grid.flat.emplace_back(ribbon.node_u[node] + v * state.eta[node], v);
    }
  }
  return grid;
}

}  // namespace wunderlich::geometry
