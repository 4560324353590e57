#include "wunderlich/baseline/rod/surface.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::baseline::rod {

Mat3 node_frame(const Rod& rod, const State& state, std::size_t node) {
  const bool first = node == 0, last = node == rod.edges();
  Section a = section(state, last || !first ? node - 1 : 0), b = section(state, last ? node - 1 : node);
  if (rod.is_loop() && (first || last)) {
    Section& beyond = first ? a : b;
    beyond = section(state, first ? rod.edges() - 1 : 0);
    if (rod.half_twists % 2 != 0) {
      beyond.m1 = -beyond.m1;
      beyond.m2 = -beyond.m2;
    }
  }
  // Each edge's section carried to the mean tangent, and between the two.
  const Vec3 tangent = (a.m3 + b.m3).normalized();
  Vec3 across = carried(a.m2, a.m3, tangent) + carried(b.m2, b.m3, tangent);
  across = (across - across.dot(tangent) * tangent).normalized();
  Mat3 frame;
  frame << across.cross(tangent), across, tangent;
  return frame;
}

std::vector<Vec3> surface_points(const Rod& rod, const State& state, int across) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const Vec3 m2 = node_frame(rod, state, i).col(1);
    for (int c = 0; c <= across; ++c) {
      points.push_back(state.x[i] + rod.width * (static_cast<double>(c) / across - 0.5) * m2);
    }
  }
  return points;
}

geometry::StripGrid surface_grid(const Rod& rod, const State& state, int across) {
  geometry::StripGrid grid{rod.segments, across, surface_points(rod, state, across), {}};
  double u = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    for (int c = 0; c <= across; ++c) grid.flat.emplace_back(u, rod.width * (static_cast<double>(c) / across - 0.5));
    if (i < rod.edges()) u += rod.rest_length[i];
  }
  return grid;
}

Mesh surface_mesh(const Rod& rod, const State& state, int across) {
  Mesh mesh;
  mesh.points = surface_points(rod, state, across);
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const Vec3 normal = node_frame(rod, state, i).col(0);
    for (int c = 0; c <= across; ++c) mesh.normals.push_back(normal);
  }
  for (int j = 0; j < rod.segments; ++j) {
    for (int c = 0; c < across; ++c) {
      const int a = j * (across + 1) + c, b = a + across + 1;
      mesh.triangles.push_back({a, a + 1, b});  // counter-clockwise seen from m1
      mesh.triangles.push_back({a + 1, b + 1, b});
    }
  }
  return mesh;
}

double largest_stretch(const Rod& rod, const State& state) {
  double most = 0;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    most = std::max(most, std::abs((state.x[j + 1] - state.x[j]).norm() / rod.rest_length[j] - 1));
  }
  return most;
}

}  // namespace wunderlich::baseline::rod
