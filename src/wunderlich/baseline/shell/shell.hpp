/// A thin inextensible shell as both baselines state it: points, distances between them that never change, and an
/// elastic energy quadratic in the points.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/baseline/shell/strip_mesh.hpp"
#include "wunderlich/geometry/ribbon.hpp"

namespace wunderlich::baseline::shell {

/// (points x 3), one row a point.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using Sparse = Eigen::SparseMatrix<double>;

/// Resolution of a strip's mesh.
struct Resolution {
  int along = 36;  ///< n, vertices over the length
  int across = 4;  ///< m, vertices over the width
};

/// The distance of two points is `rest` [m].
struct Length {
  std::array<int, 2> points{};
  double rest = 0;
};

/// Constant through a run.
struct Shell {
  geometry::RibbonSpec strip;
  StripMesh mesh;
  std::vector<Vec2> flat;          ///< (u, v) of the points in the flat strip [m]; vertices, or midpoints of edges
  std::vector<double> mass;        ///< of the points [kg]; ghosts weigh too, which only a clamp that slides feels
  std::vector<double> strip_mass;  ///< the same of the strip alone, without ghosts [kg]
  std::vector<std::vector<Length>> lengths;  ///< in sets that are enforced one after the other
  Sparse bending;                            ///< K, so that the elastic energy is tr(x^T K x)/2 [N/m]
  Sparse boundary;                           ///< rows whose product with x must vanish; none in a conforming shell
  double boundary_scale = 1;                 ///< length that their values are measured by [m]
  Sparse drawn;                              ///< drawn vertices from points: x_drawn = drawn x

  int point_count() const { return static_cast<int>(flat.size()); }
};

/// A third of each triangle's mass to the points that stand for its corners, or its edges.
void lump_masses(const std::vector<std::array<int, 3>>& points_of_triangles, Shell& shell);

int length_count(const Shell& shell);

/// Where it lies undeformed: along +x from the origin, its normal +z, v along -y.
Points straight_points(const Shell& shell);

}  // namespace wunderlich::baseline::shell
