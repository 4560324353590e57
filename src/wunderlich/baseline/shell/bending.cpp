#include "wunderlich/baseline/shell/bending.hpp"

#include <cassert>
#include <cmath>

namespace wunderlich::baseline::shell {

namespace {

Vec2 flat_vertex(const StripMesh& mesh, int vertex) { return mesh.vertices[static_cast<std::size_t>(vertex)]; }

/// |e| times the conormal of `edge` that leaves the triangle, in the flat strip.
Vec2 outward(const StripMesh& mesh, const Edge& edge, int triangle) {
  const Vec2 along = flat_vertex(mesh, edge.ends[1]) - flat_vertex(mesh, edge.ends[0]);
  const Vec2 normal(along.y(), -along.x());
  Vec2 center = Vec2::Zero();
  for (const int v : mesh.triangles[static_cast<std::size_t>(triangle)]) center += flat_vertex(mesh, v) / 3;
  return normal.dot(center - flat_vertex(mesh, edge.ends[0])) > 0 ? Vec2(-normal) : normal;
}

/// The flux through the edge of what is `scale` hat functions in each of its triangles, numbered by `points_of`.
Stencil flux(const StripMesh& mesh, int edge, double scale, const std::vector<std::array<int, 3>>& points_of) {
  const Edge& e = mesh.edges[static_cast<std::size_t>(edge)];
  assert(e.triangles[1] >= 0);
  Stencil stencil;
  for (const int t : e.triangles) {
    const Vec2 normal = outward(mesh, e, t);
    for (int k = 0; k < 3; ++k) {
      stencil.points.push_back(points_of[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
      stencil.weights.push_back(scale * normal.dot(hat_gradient(mesh, t, k)));
    }
  }
  return stencil;
}

double real_area(const StripMesh& mesh, const Edge& edge) {
  double area = 0;
  for (const int t : edge.triangles) area += mesh.ghost[static_cast<std::size_t>(t)] ? 0 : mesh.triangle_area();
  return area;
}

}  // namespace

Stencil vertex_stencil(const StripMesh& mesh, int edge) { return flux(mesh, edge, 1, mesh.triangles); }

// The function that is 1 at the midpoint opposite vertex k and 0 at the others is 1 - 2 hat_k.
Stencil midpoint_stencil(const StripMesh& mesh, int edge) { return flux(mesh, edge, -2, mesh.triangle_edges); }

Sparse bending_matrix(const StripMesh& mesh, double stiffness, double share, Stencil (*stencil)(const StripMesh&, int),
                      int point_count) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edges[e].triangles[1] < 0) continue;
    const double area = real_area(mesh, mesh.edges[e]);
    if (area == 0) continue;
    const Stencil h = stencil(mesh, static_cast<int>(e));
    for (std::size_t a = 0; a < h.points.size(); ++a) {
      for (std::size_t b = 0; b < h.points.size(); ++b) {
        triplets.emplace_back(h.points[a], h.points[b], stiffness * share / area * h.weights[a] * h.weights[b]);
      }
    }
  }
  Sparse matrix(point_count, point_count);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

double bending_energy(const Shell& shell, const Points& x) { return 0.5 * x.cwiseProduct(shell.bending * x).sum(); }

}  // namespace wunderlich::baseline::shell
