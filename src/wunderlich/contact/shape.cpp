#include "wunderlich/contact/shape.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/contact/triangle_mesh.hpp"

namespace wunderlich::contact {

namespace {

/// Two points nearer than this are one: their direction means nothing, and one over their distance could overflow [m].
constexpr double coincident = 1e-30;

/// Distance in the solid's own frame. Its Hessian is `curvature` (I - n n^T) + `excess` m m^T, m = `direction`: that of
/// any distance, since its Hessian maps the normal to zero and has two principal directions otherwise.
struct Local {
  double value = 0;
  Vec3 normal = Vec3::UnitZ();
  double curvature = 0;
  double excess = 0;
  Vec3 direction = Vec3::UnitX();
};

/// Distance from a point, less a radius.
inline Local from_point(const Vec3& offset, double radius) {
  const double r = offset.norm();
  if (r < coincident) return {-radius, Vec3::UnitZ()};
  const double over_r = 1 / r;
  return {r - radius, over_r * offset, over_r};
}

/// A point in cylindrical coordinates; on the axis x stands for the radial direction.
struct Cylindrical {
  double r = 0;
  Vec3 radial = Vec3::UnitX();
  Vec3 around = Vec3::UnitY();
  double curvature = 0;  ///< of the coordinate circle, none on the axis
};

inline Cylindrical cylindrical(const Vec3& p) {
  const double r = p.head<2>().norm();
  if (r < coincident) return {};
  const double over_r = 1 / r;
  const Vec3 radial(over_r * p.x(), over_r * p.y(), 0);
  return {r, radial, {-radial.y(), radial.x(), 0}, over_r};
}

/// Distance from the z axis, less a radius.
inline Local from_axis(const Cylindrical& c, double radius) {
  return {c.r - radius, c.radial, 0, c.curvature, c.around};
}

inline Local local_distance(const HalfSpace&, const Vec3& p) { return {p.z(), Vec3::UnitZ()}; }

inline Local local_distance(const Sphere& sphere, const Vec3& p) { return from_point(p, sphere.radius); }

inline Local local_distance(const Cylinder& cylinder, const Vec3& p) {
  const Cylindrical c = cylindrical(p);
  const double side = c.r - cylinder.radius;
  const double end = std::abs(p.z()) - cylinder.half_length;
  const Vec3 axial(0, 0, std::copysign(1.0, p.z()));
  if (side > 0 && end > 0) {
    // Nearest is the rim: across it the distance is that from a point, along it the rim's circle bends less.
    const double d = std::sqrt(side * side + end * end);
    if (d > coincident) {
      const Vec3 normal = (side * c.radial + end * axial) / d;
      return {d, normal, 1 / d, side / d * c.curvature - 1 / d, c.around};
    }
  }
  return side > end ? from_axis(c, cylinder.radius) : Local{end, axial};
}

inline Local local_distance(const Capsule& capsule, const Vec3& p) {
  if (std::abs(p.z()) < capsule.half_length) return from_axis(cylindrical(p), capsule.radius);
  return from_point({p.x(), p.y(), p.z() - std::copysign(capsule.half_length, p.z())}, capsule.radius);
}

inline Local local_distance(const Box& box, const Vec3& p) {
  const Vec3 beyond = p.cwiseAbs() - box.half_size;
  const Vec3 outside = beyond.cwiseMax(0.0);
  const Vec3 sign(std::copysign(1.0, p.x()), std::copysign(1.0, p.y()), std::copysign(1.0, p.z()));
  const auto axes_beyond = (beyond.array() > 0).count();
  const double d = outside.norm();
  if (axes_beyond < 2 || d < coincident) {
    Eigen::Index axis = 0;
    const double largest = beyond.maxCoeff(&axis);
    return {largest, sign[axis] * Vec3::Unit(axis)};
  }
  Local corner{d, sign.cwiseProduct(outside) / d, 1 / d};
  if (axes_beyond == 2) {  // an edge: straight along the third axis
    Eigen::Index along = 0;
    beyond.minCoeff(&along);
    corner.excess = -1 / d;
    corner.direction = Vec3::Unit(along);
  }
  return corner;
}

Local local_distance(const Polyhedron&, const Vec3&) { return {}; }  // has its own, below

}  // namespace

Distance distance(const Shape& shape, const Vec3& point) {
  if (const auto* polyhedron = std::get_if<Polyhedron>(&shape)) return distance(*polyhedron->mesh, point);
  const Local local = std::visit([&](const auto& solid) { return local_distance(solid, point); }, shape);
  Distance result{local.value, local.normal, Mat3::Zero()};
  if (local.curvature != 0) {
    result.hessian = local.curvature * (Mat3::Identity() - result.normal * result.normal.transpose());
  }
  if (local.excess != 0) result.hessian += local.excess * local.direction * local.direction.transpose();
  return result;
}

void distances(const Shape& shape, std::size_t count, const Vec3* points, double* values, Vec3* normals) {
  const auto fill = [&](const auto& solid) {
    for (std::size_t i = 0; i < count; ++i) {
      const Local local = local_distance(solid, points[i]);
      values[i] = local.value;
      normals[i] = local.normal;
    }
  };
  std::visit(fill, shape);
}

Bend bend(const Shape& shape, const Vec3& point) {
  const Local local = std::visit([&](const auto& solid) { return local_distance(solid, point); }, shape);
  if (local.curvature == 0) return {{local.excess, 0}, {local.direction, Vec3::Zero()}};
  const Vec3 first = local.excess != 0 ? local.direction : Vec3(local.normal.unitOrthogonal());
  return {{local.curvature + local.excess, local.curvature}, {first, local.normal.cross(first)}};
}

Distance distance(const Shape& shape, const Pose& pose, const Vec3& point) {
  const Mat3 rotation = pose.frame.toRotationMatrix();
  const Distance own = distance(shape, Vec3(rotation.transpose() * (point - pose.position)));
  return {own.value, rotation * own.normal, rotation * own.hessian * rotation.transpose()};
}

}  // namespace wunderlich::contact
