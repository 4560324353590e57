#include "wunderlich/contact/mesh.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/contact/triangle_mesh.hpp"

namespace wunderlich::contact {

namespace {

constexpr int sectors = 64;    // around an axis
constexpr int arc_steps = 16;  // of a quarter circle

/// A point of the curve that a surface of revolution is made of, with the surface's normal there.
struct ProfilePoint {
  double r = 0;
  double z = 0;
  double normal_r = 0;
  double normal_z = 0;
};

/// Turns a curve about z. The outside is on its right where it goes up.
void revolve(const std::vector<ProfilePoint>& profile, Mesh& mesh) {
  const auto first = static_cast<int>(mesh.points.size());
  for (const ProfilePoint& p : profile) {
    for (int k = 0; k <= sectors; ++k) {
      const double angle = 2 * EIGEN_PI * (k % sectors) / sectors;
      const double c = std::cos(angle), s = std::sin(angle);
      mesh.points.emplace_back(p.r * c, p.r * s, p.z);
      mesh.normals.emplace_back(p.normal_r * c, p.normal_r * s, p.normal_z);
    }
  }
  const int row = sectors + 1;
  for (int i = 0; i + 1 < static_cast<int>(profile.size()); ++i) {
    for (int k = 0; k < sectors; ++k) {
      const int a = first + i * row + k;
      mesh.triangles.push_back({a, a + 1, a + row});
      mesh.triangles.push_back({a + 1, a + row + 1, a + row});
    }
  }
}

/// The rectangle center + [-1, 1] a + [-1, 1] b, its outside towards a x b.
void add_rectangle(const Vec3& center, const Vec3& a, const Vec3& b, Mesh& mesh) {
  const auto first = static_cast<int>(mesh.points.size());
  for (const Vec3& corner : {Vec3(-a - b), Vec3(a - b), Vec3(a + b), Vec3(b - a)}) {
    mesh.points.push_back(center + corner);
    mesh.normals.push_back(a.cross(b).normalized());
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Two quarter circles, from the lowest to the highest point; between them a straight line where they are apart.
std::vector<ProfilePoint> round_profile(double radius, double half_length) {
  std::vector<ProfilePoint> profile;
  for (const int side : {-1, 1}) {
    for (int i = 0; i <= arc_steps; ++i) {
      const double latitude = 0.5 * EIGEN_PI * (side < 0 ? i - arc_steps : i) / arc_steps;
      const double r = std::cos(latitude), z = std::sin(latitude);
      profile.push_back({radius * r, side * half_length + radius * z, r, z});
    }
  }
  return profile;
}

void add_surface(const HalfSpace&, double extent, Mesh& mesh) {
  add_rectangle(Vec3::Zero(), {extent, 0, 0}, {0, extent, 0}, mesh);
}

void add_surface(const Sphere& sphere, double, Mesh& mesh) { revolve(round_profile(sphere.radius, 0), mesh); }

void add_surface(const Cylinder& cylinder, double extent, Mesh& mesh) {
  const double r = cylinder.radius;
  const double h = std::isfinite(cylinder.half_length) ? cylinder.half_length : extent;
  revolve({{0, -h, 0, -1}, {r, -h, 0, -1}}, mesh);
  revolve({{r, -h, 1, 0}, {r, h, 1, 0}}, mesh);
  revolve({{r, h, 0, 1}, {0, h, 0, 1}}, mesh);
}

void add_surface(const Capsule& capsule, double, Mesh& mesh) {
  revolve(round_profile(capsule.radius, capsule.half_length), mesh);
}

void add_surface(const Box& box, double, Mesh& mesh) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 out = box.half_size[k] * Vec3::Unit(k);
    const Vec3 a = box.half_size[(k + 1) % 3] * Vec3::Unit((k + 1) % 3);
    const Vec3 b = box.half_size[(k + 2) % 3] * Vec3::Unit((k + 2) % 3);
    add_rectangle(out, a, b, mesh);
    add_rectangle(-out, b, a, mesh);
  }
}

/// Each triangle with points of its own: no edge is rounded off.
void add_surface(const Polyhedron& polyhedron, double, Mesh& mesh) {
  for (const auto& triangle : polyhedron.mesh->triangles) {
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return polyhedron.mesh->vertices[static_cast<std::size_t>(triangle[k])];
    };
    const auto first = static_cast<int>(mesh.points.size());
    const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.points.push_back(corner(k));
      mesh.normals.push_back(normal);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

}  // namespace

Mesh mesh_of(const Shape& shape, double extent) {
  Mesh mesh;
  std::visit([&](const auto& solid) { add_surface(solid, extent, mesh); }, shape);
  return mesh;
}

}  // namespace wunderlich::contact
