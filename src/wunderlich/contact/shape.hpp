/// Solids that a strip can touch, and how far a point is from their surface.
#pragma once

#include <cstddef>
#include <memory>
#include <variant>

#include "wunderlich/base/types.hpp"

namespace wunderlich::contact {

struct TriangleMesh;

// Solids in their own frame, centred at its origin, axes along z. Lengths in m.
struct HalfSpace {};  ///< all z <= 0; its surface is the plane z = 0
struct Sphere {
  double radius = 0;
};
/// With flat ends; `half_length` may be infinite.
struct Cylinder {
  double radius = 0;
  double half_length = 0;
};
/// All points within `radius` of a segment; `half_length` is that of the segment, without the round ends.
struct Capsule {
  double radius = 0;
  double half_length = 0;
};
struct Box {
  Vec3 half_size = Vec3::Zero();
};
/// Inside a closed surface of triangles; never null.
struct Polyhedron {
  std::shared_ptr<const TriangleMesh> mesh;
};

using Shape = std::variant<HalfSpace, Sphere, Cylinder, Capsule, Box, Polyhedron>;

/// Signed distance of a point to a solid's surface, with its derivatives with respect to the point.
struct Distance {
  double value = 0;  ///< [m], negative inside
  Vec3 normal;       ///< gradient: unit, outward
  Mat3 hessian;      ///< [1/m]
};

/// Outside it is the Euclidean distance. Where the nearest point of the surface is not unique (on axes, in centers, on
/// edges) normal and Hessian are those of one side; all numbers are finite everywhere.
/// The point is given in the solid's own frame, and so is the result.
Distance distance(const Shape& shape, const Vec3& point);

/// Values and normals alone, of many points at once.
void distances(const Shape& shape, std::size_t count, const Vec3* points, double* values, Vec3* normals);

/// The Hessian of the distance as its principal curvatures [1/m] and directions, two square to the normal.
struct Bend {
  double curvature[2];
  Vec3 direction[2];
};
Bend bend(const Shape& shape, const Vec3& point);

/// Distance in space; `pose` is where the solid's own frame stands.
Distance distance(const Shape& shape, const Pose& pose, const Vec3& point);

}  // namespace wunderlich::contact
