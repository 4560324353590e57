#include "wunderlich/contact/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "wunderlich/contact/pair.hpp"

namespace wunderlich::contact {

namespace {

using std::numbers::pi;

constexpr double kFlat = 1e-9;  // a triangle's height over its length, sine of the angle between faces

using Triangles = std::vector<std::array<int, 3>>;

/// One side of a triangle, from its smaller vertex to the larger one, or the other way.
struct Side {
  std::array<int, 2> edge;
  bool forward;
  std::size_t triangle;
  int opposite;  ///< the triangle's third vertex
};

/// All sides, those of one edge together.
std::vector<Side> sides_of(const Triangles& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, a < b, t, triangles[t][(k + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle; });
  return sides;
}

const Vec3& at(const std::vector<Vec3>& vertices, int i) { return vertices[static_cast<std::size_t>(i)]; }

Vec3 area_vector(const std::vector<Vec3>& vertices, const std::array<int, 3>& t) {
  const Vec3& a = at(vertices, t[0]);
  return (at(vertices, t[1]) - a).cross(at(vertices, t[2]) - a);
}

/// Where a face's neighbour lies below its plane.
bool is_ridge(const std::vector<Vec3>& vertices, const Triangles& triangles, const Side& a, const Side& b) {
  const Vec3 normal = area_vector(vertices, triangles[a.triangle]).normalized();
  const Vec3 out = at(vertices, b.opposite) - at(vertices, a.edge[0]);
  return normal.dot(out) < -kFlat * out.norm();
}

Extent box_of(const Vec3& a) { return {a, a}; }

void build_trees(TriangleMesh& mesh) {
  std::vector<Extent> extents;
  for (const auto& t : mesh.triangles) {
    extents.push_back(box_of(at(mesh.vertices, t[0])));
    for (const int i : {t[1], t[2]}) extents.back().add(at(mesh.vertices, i));
  }
  const Grid grid = grid_over(extents);
  build_tree(extents, grid, mesh.triangle_tree);
  extents.clear();
  for (const auto& edge : mesh.ridges) {
    extents.push_back(box_of(at(mesh.vertices, edge[0])));
    extents.back().add(at(mesh.vertices, edge[1]));
  }
  build_tree(extents, grid, mesh.ridge_tree);
  extents.clear();
  for (const int i : mesh.peaks) extents.push_back(box_of(at(mesh.vertices, i)));
  build_tree(extents, grid, mesh.peak_tree);
}

}  // namespace

FaultAt find_fault(const std::vector<Vec3>& vertices, const Triangles& triangles) {
  double six_volumes = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 area = area_vector(vertices, triangles[t]);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 side = at(vertices, triangles[t][k]) - at(vertices, triangles[t][(k + 1) % 3]);
      longest = std::max(longest, side.squaredNorm());
    }
    if (!(area.norm() > kFlat * longest)) return {MeshFault::no_area, t};
    six_volumes += area.dot(at(vertices, triangles[t][0]) - at(vertices, triangles[0][0]));
  }
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    if (end - i == 1) return {MeshFault::open, sides[i].triangle};
    if (end - i > 2) return {MeshFault::crowded, sides[end - 1].triangle};
    if (sides[i].forward == sides[i + 1].forward) return {MeshFault::turned, sides[i + 1].triangle};
    i = end;
  }
  if (!(six_volumes > 0)) return {MeshFault::inside_out, 0};
  return {};
}

TriangleMesh make_mesh(std::vector<Vec3> vertices, Triangles triangles) {
  TriangleMesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.triangles = std::move(triangles);
  const std::vector<Side> sides = sides_of(mesh.triangles);
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    if (!is_ridge(mesh.vertices, mesh.triangles, sides[i], sides[i + 1])) continue;
    mesh.ridges.push_back(sides[i].edge);
    mesh.peaks.insert(mesh.peaks.end(), sides[i].edge.begin(), sides[i].edge.end());
  }
  std::sort(mesh.peaks.begin(), mesh.peaks.end());
  mesh.peaks.erase(std::unique(mesh.peaks.begin(), mesh.peaks.end()), mesh.peaks.end());
  mesh.whole = box_of(at(mesh.vertices, mesh.triangles.front()[0]));
  for (const auto& triangle : mesh.triangles) {
    for (const int i : triangle) mesh.whole.add(at(mesh.vertices, i));
  }
  build_trees(mesh);
  return mesh;
}

TriangleMesh mesh_of(const Box& box) {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) {  // bit k of i: which side along axis k
    const Vec3 side((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    vertices.push_back(side.cwiseProduct(box.half_size));
  }
  Triangles triangles;
  for (int k = 0; k < 3; ++k) {
    const int a = 1 << (k + 1) % 3, b = 1 << (k + 2) % 3, c = 1 << k;
    triangles.push_back({c, c + a, c + a + b});
    triangles.push_back({c, c + a + b, c + b});
    triangles.push_back({0, a + b, a});
    triangles.push_back({0, b, a + b});
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

TriangleMesh end_of(const Cylinder& cylinder, int side, double beyond) {
  const double half_angle = std::acos(cylinder.radius / (cylinder.radius + beyond));
  const int sides = static_cast<int>(std::clamp(std::ceil(pi / half_angle), 8.0, 2000.0));
  const double radius = cylinder.radius / std::cos(pi / sides), end = side * cylinder.half_length;
  const double other = end - side * std::min(cylinder.half_length, 0.25 * cylinder.radius);
  std::vector<Vec3> vertices;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * pi * k / sides;
    for (const double z : {std::min(end, other), std::max(end, other)})
      vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  Triangles triangles;
  for (int k = 0; k < sides; ++k) {
    const int low = 2 * k, next = 2 * ((k + 1) % sides);
    triangles.push_back({low, next, next + 1});
    triangles.push_back({low, next + 1, low + 1});
    if (k == 0 || k == sides - 1) continue;
    triangles.push_back({0, next, low});
    triangles.push_back({1, low + 1, next + 1});
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

double winding(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0;  // of solid angles
  for (const auto& triangle : mesh.triangles) {
    const Vec3 a = at(mesh.vertices, triangle[0]) - point, b = at(mesh.vertices, triangle[1]) - point;
    const Vec3 c = at(mesh.vertices, triangle[2]) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * pi);
}

Distance distance(const TriangleMesh& mesh, const Vec3& point) {
  PairNearest best{std::numeric_limits<double>::infinity(), Vec3::UnitZ(), Vec4::Zero()};
  PairPoints corners{};
  for (const auto& t : mesh.triangles) {
    const PairPoints x{point, at(mesh.vertices, t[0]), at(mesh.vertices, t[1]), at(mesh.vertices, t[2])};
    const PairNearest nearest = pair_nearest(PairKind::vertex_triangle, x);
    if (!(nearest.distance < best.distance)) continue;
    best = nearest;
    corners = x;
  }
  const double sign = winding(mesh, point) > 0.5 ? -1 : 1;
  if (!(best.distance > 0)) {
    return {0, (corners[2] - corners[1]).cross(corners[3] - corners[1]).normalized(), Mat3::Zero()};
  }
  const Vec3 normal = sign / best.distance * best.way;
  Mat3 hessian = Mat3::Zero();
  const auto carriers = (best.weights.tail<3>().array() != 0).count();
  if (carriers < 3) hessian = Mat3::Identity() - normal * normal.transpose();
  if (carriers == 2) {  // straight along the edge
    Vec3 ends[2];
    int count = 0;
    for (int k = 1; k < 4; ++k) {
      if (best.weights[k] != 0) ends[count++] = corners[static_cast<std::size_t>(k)];
    }
    const Vec3 along = (ends[1] - ends[0]).normalized();
    hessian -= along * along.transpose();
  }
  return {sign * best.distance, normal, sign / best.distance * hessian};
}

bool pierces(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double start = normal.dot(from - a), end = normal.dot(to - a);
  if (start * end > 0 || start == end) return false;
  const Vec3 at = from + start / (start - end) * (to - from);
  return normal.dot((b - a).cross(at - a)) >= 0 && normal.dot((c - b).cross(at - b)) >= 0 &&
         normal.dot((a - c).cross(at - c)) >= 0;
}

}  // namespace wunderlich::contact
