#include "wunderlich/baseline/shell/measure.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::baseline::shell {

namespace {

Vec3 at(const Points& x, int row) { return x.row(row).transpose(); }

}  // namespace

void lump_masses(const std::vector<std::array<int, 3>>& points_of_triangles, Shell& shell) {
  shell.mass.assign(shell.flat.size(), 0);
  shell.strip_mass.assign(shell.flat.size(), 0);
  const double third = shell.strip.area_density * shell.mesh.triangle_area() / 3;
  for (std::size_t t = 0; t < points_of_triangles.size(); ++t) {
    for (const int p : points_of_triangles[t]) {
      shell.mass[static_cast<std::size_t>(p)] += third;
      if (!shell.mesh.ghost[t]) shell.strip_mass[static_cast<std::size_t>(p)] += third;
    }
  }
}

int length_count(const Shell& shell) {
  std::size_t count = 0;
  for (const auto& set : shell.lengths) count += set.size();
  return static_cast<int>(count);
}

Points straight_points(const Shell& shell) {
  Points x(shell.point_count(), 3);
  for (int p = 0; p < shell.point_count(); ++p) {
    const Vec2& flat = shell.flat[static_cast<std::size_t>(p)];
    x.row(p) << flat.x(), -flat.y(), 0;
  }
  return x;
}

Points drawn_vertices(const Shell& shell, const Points& x) { return shell.drawn * x; }

Mesh surface_mesh(const Shell& shell, const Points& x) {
  const Points vertices = drawn_vertices(shell, x);
  const int first = shell.mesh.ghosts[0] * shell.mesh.across;
  const int last = (shell.mesh.columns - shell.mesh.ghosts[1]) * shell.mesh.across;
  Mesh mesh;
  for (int v = first; v < last; ++v) mesh.points.push_back(at(vertices, v));
  mesh.normals.assign(mesh.points.size(), Vec3::Zero());
  for (std::size_t t = 0; t < shell.mesh.triangles.size(); ++t) {
    if (shell.mesh.ghost[t]) continue;
    std::array<int, 3> corners = shell.mesh.triangles[t];
    for (int& v : corners) v -= first;
    const auto point = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(corners[k])]; };
    const Vec3 normal = (point(2) - point(0)).cross(point(1) - point(0));  // v runs along -y: clockwise from above
    for (const int v : corners) mesh.normals[static_cast<std::size_t>(v)] += normal;
    mesh.triangles.push_back({corners[0], corners[2], corners[1]});
  }
  for (Vec3& normal : mesh.normals) normal.normalize();
  return mesh;
}

double length_error(const Shell& shell, const Points& x) {
  double error = 0;
  for (const auto& set : shell.lengths) error = std::max(error, max_length_error(set, x));
  return error;
}

double kinetic_energy(const Shell& shell, const Points& v) {
  double energy = 0;
  for (int p = 0; p < shell.point_count(); ++p)
    energy += 0.5 * shell.mass[static_cast<std::size_t>(p)] * v.row(p).squaredNorm();
  return energy;
}

double gravity_energy(const Shell& shell, const Vec3& gravity, const Points& x) {
  double energy = 0;
  for (int p = 0; p < shell.point_count(); ++p)
    energy -= shell.strip_mass[static_cast<std::size_t>(p)] * gravity.dot(at(x, p));
  return energy;
}

int degrees_of_freedom(const Shell& shell) {
  const double slack = 1e-6 * shell.mesh.cell_length;
  return 3 * static_cast<int>(std::count_if(shell.flat.begin(), shell.flat.end(), [&](const Vec2& at) {
           return at.x() > -slack && at.x() < shell.strip.length + slack;
         }));
}

int constraint_count(const Shell& shell) { return length_count(shell) + 3 * static_cast<int>(shell.boundary.rows()); }

}  // namespace wunderlich::baseline::shell
