#include "wunderlich/baseline/rod/surface.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/baseline/rod/energy.hpp"

namespace wunderlich::baseline::rod {

namespace {

/// Gauss points and weights on [0, 1].
constexpr double kAt[] = {0.5 - 0.43056815579702629, 0.5 - 0.16999052179242813, 0.5 + 0.16999052179242813,
                          0.5 + 0.43056815579702629};
constexpr double kWeight[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

/// The rims' points at the nodes.
struct Rims {
  std::vector<Vec3> low, high;
};
Rims rims(const Rod& rod, const State& state) {
  Rims out;
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const Vec3 half = 0.5 * rod.width * node_frame(rod, state, i).col(1);
    out.low.push_back(state.x[i] - half);
    out.high.push_back(state.x[i] + half);
  }
  return out;
}

/// Area between two nodes; across directions in between are those of the nodes mixed, at unit length.
double patch_area(double width, const Vec3& edge, const Vec3& across0, const Vec3& across1) {
  double area = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3 mix = (1 - kAt[i]) * across0 + kAt[i] * across1, across = mix.normalized();
    const Vec3 change = across1 - across0, turn = (change - change.dot(across) * across) / mix.norm();
    for (int k = 0; k < 4; ++k) {
      area += kWeight[i] * kWeight[k] * width * (edge + width * (kAt[k] - 0.5) * turn).cross(across).norm();
    }
  }
  return area;
}

double length_of(const std::vector<Vec3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

}  // namespace

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

double area_change(const Rod& rod, const State& state) {
  double area = 0;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    area += patch_area(rod.width, state.x[j + 1] - state.x[j], node_frame(rod, state, j).col(1),
                       node_frame(rod, state, j + 1).col(1));
  }
  return area / (rod.length * rod.width) - 1;
}

std::array<double, 2> rim_stretch(const Rod& rod, const State& state) {
  const Rims rim = rims(rod, state);
  return {length_of(rim.low) / rod.length - 1, length_of(rim.high) / rod.length - 1};
}

double largest_stretch(const Rod& rod, const State& state) {
  double most = 0;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    most = std::max(most, std::abs((state.x[j + 1] - state.x[j]).norm() / rod.rest_length[j] - 1));
  }
  return most;
}

std::vector<CenterlineSample> centerline(const Rod& rod, const State& state) {
  std::vector<CenterlineSample> out;
  double u = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const Mat3 frame = node_frame(rod, state, i);
    CenterlineSample s;
    s.u = u;
    s.r = state.x[i];
    s.d1 = frame.col(0);
    s.d2 = frame.col(1);
    s.d3 = frame.col(2);
    if (rod.hinge_length[i] > 0) {
      const Strain strains = strain(rod, state, i);
      s.kappa = strains.soft;
      s.tau = strains.twist;
    }
    out.push_back(s);
    if (i < rod.edges()) u += rod.rest_length[i];
  }
  return out;
}

}  // namespace wunderlich::baseline::rod
