#include "wunderlich/baseline/shell_nonconforming/nonconforming.hpp"

#include <array>

#include "wunderlich/baseline/shell/bending.hpp"

namespace wunderlich::baseline::shell_nonconforming {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kShare = 3;

/// Adds `weight` times where triangle `t` puts its corner `k`.   @eq English2008
void add_corner(const shell::StripMesh& mesh, std::size_t t, std::size_t k, int row, double weight, Triplets& out) {
  const auto& edges = mesh.triangle_edges[t];
  out.emplace_back(row, edges[k], -weight);
  out.emplace_back(row, edges[(k + 1) % 3], weight);
  out.emplace_back(row, edges[(k + 2) % 3], weight);
}

std::size_t corner_of(const shell::StripMesh& mesh, std::size_t t, int vertex) {
  std::size_t k = 0;
  while (mesh.triangles[t][k] != vertex) ++k;
  return k;
}

shell::Sparse to_sparse(const Triplets& triplets, Eigen::Index rows, Eigen::Index columns) {
  shell::Sparse matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

shell::Sparse drawn_vertices(const shell::StripMesh& mesh) {
  std::vector<int> fans(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) ++fans[static_cast<std::size_t>(v)];
  }
  Triplets triplets;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = mesh.triangles[t][k];
      add_corner(mesh, t, k, v, 1.0 / fans[static_cast<std::size_t>(v)], triplets);
    }
  }
  return to_sparse(triplets, static_cast<Eigen::Index>(mesh.vertices.size()),
                   static_cast<Eigen::Index>(mesh.edges.size()));
}

/// One row a rim vertex whose two rim edges belong to different triangles, ghosts left out.
shell::Sparse boundary_rows(const shell::StripMesh& mesh) {
  std::vector<std::vector<std::size_t>> triangles(mesh.vertices.size());
  for (const shell::Edge& edge : mesh.edges) {
    if (edge.triangles[1] >= 0) continue;
    for (const int v : edge.ends)
      triangles[static_cast<std::size_t>(v)].push_back(static_cast<std::size_t>(edge.triangles[0]));
  }
  Triplets triplets;
  int row = 0;
  for (std::size_t v = 0; v < triangles.size(); ++v) {
    if (triangles[v].size() != 2 || triangles[v][0] == triangles[v][1]) continue;
    if (mesh.ghost[triangles[v][0]] && mesh.ghost[triangles[v][1]]) continue;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t t = triangles[v][side];
      add_corner(mesh, t, corner_of(mesh, t, static_cast<int>(v)), row, side == 0 ? 1.0 : -1.0, triplets);
    }
    ++row;
  }
  return to_sparse(triplets, row, static_cast<Eigen::Index>(mesh.edges.size()));
}

}  // namespace

shell::Shell make_shell(const geometry::RibbonSpec& strip, const shell::Resolution& resolution) {
  shell::Shell shell;
  shell.strip = strip;
  shell.mesh = shell::make_strip_mesh(strip.length, strip.width, resolution.along, resolution.across, strip.clamped);
  const shell::StripMesh& mesh = shell.mesh;
  for (const shell::Edge& edge : mesh.edges) {
    shell.flat.push_back((mesh.vertices[static_cast<std::size_t>(edge.ends[0])] +
                          mesh.vertices[static_cast<std::size_t>(edge.ends[1])]) /
                         2);
  }
  shell::lump_masses(mesh.triangle_edges, shell);
  shell.lengths.resize(1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& edges = mesh.triangle_edges[t];
    for (std::size_t k = 0; k < 3 && !mesh.ghost[t]; ++k) {
      const std::array<int, 2> ends{edges[k], edges[(k + 1) % 3]};
      const Vec2 gap = shell.flat[static_cast<std::size_t>(ends[1])] - shell.flat[static_cast<std::size_t>(ends[0])];
      shell.lengths[0].push_back({ends, gap.norm()});
    }
  }
  shell.bending =
      shell::bending_matrix(mesh, strip.bending_stiffness, kShare, shell::midpoint_stencil, shell.point_count());
  shell.boundary = boundary_rows(mesh);
  shell.boundary_scale = mesh.cell_length;
  shell.drawn = drawn_vertices(mesh);
  return shell;
}

shell::Points midpoints(const shell::Shell& shell, const shell::Points& vertices) {
  shell::Points x(shell.point_count(), 3);
  for (int e = 0; e < shell.point_count(); ++e) {
    const auto& ends = shell.mesh.edges[static_cast<std::size_t>(e)].ends;
    x.row(e) = (vertices.row(ends[0]) + vertices.row(ends[1])) / 2;
  }
  return x;
}

}  // namespace wunderlich::baseline::shell_nonconforming
