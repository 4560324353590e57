/// Closed surfaces of triangles as solids.
#pragma once

#include "wunderlich/contact/near_pairs.hpp"
#include "wunderlich/contact/shape.hpp"

namespace wunderlich::contact {

/// Corners counter-clockwise seen from outside. What touches such a solid from outside touches a triangle, a ridge or a
/// peak: at an edge that is flat or hollow a face is as near.
struct TriangleMesh {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 2>> ridges;  ///< edges where two faces meet at less than 180 degrees, each once
  std::vector<int> peaks;                  ///< vertices on ridges
  Extent whole;
  ExtentTree triangle_tree, ridge_tree, peak_tree;  ///< with the grid of the triangles' one
};

/// What is wrong with triangles as the surface of a solid.
enum class MeshFault {
  none,
  no_area,     ///< a triangle without
  open,        ///< an edge of one triangle alone
  crowded,     ///< an edge of more than two
  turned,      ///< neighbours that are not turned alike
  inside_out,  ///< all clockwise seen from outside
};
struct FaultAt {
  MeshFault fault = MeshFault::none;
  std::size_t triangle = 0;  ///< where
};

/// Indices must be those of vertices.
FaultAt find_fault(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles);

/// Of triangles without a fault.
TriangleMesh make_mesh(std::vector<Vec3> vertices, std::vector<std::array<int, 3>> triangles);

/// A box in its own frame: eight vertices, twelve triangles.
TriangleMesh mesh_of(const Box& box);

/// The last piece of a cylinder before its end at z = half_length, or z = -half_length for side = -1, as a prism around
/// it that stands out nowhere by more than `beyond` [m].
TriangleMesh end_of(const Cylinder& cylinder, int side, double beyond);

/// Times that the surface goes round a point: 1 inside, 0 outside, to rounding (vanOosterom1983).
double winding(const TriangleMesh& mesh, const Vec3& point);

/// Signed distance to the surface, by looking at all triangles.
Distance distance(const TriangleMesh& mesh, const Vec3& point);

/// Does a straight piece meet a triangle? Touching counts, lying in its plane does not.
bool pierces(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace wunderlich::contact
