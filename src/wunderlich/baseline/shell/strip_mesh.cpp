#include "wunderlich/baseline/shell/strip_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <map>

namespace wunderlich::baseline::shell {

namespace {

void add_cells(StripMesh& mesh) {
  for (int i = 0; i + 1 < mesh.columns; ++i) {
    const bool ghost = i < mesh.ghosts[0] || i + 1 >= mesh.columns - mesh.ghosts[1];
    for (int j = 0; j + 1 < mesh.across; ++j) {
      const int a = mesh.vertex(i, j), b = mesh.vertex(i + 1, j), c = mesh.vertex(i + 1, j + 1),
                d = mesh.vertex(i, j + 1);
      const bool rising = (i - mesh.ghosts[0] + j) % 2 == 0;
      mesh.triangles.push_back(rising ? std::array{a, b, c} : std::array{a, b, d});
      mesh.triangles.push_back(rising ? std::array{a, c, d} : std::array{b, c, d});
      mesh.ghost.insert(mesh.ghost.end(), 2, ghost);
    }
  }
}

void add_edges(StripMesh& mesh) {
  std::map<std::array<int, 2>, int> known;
  mesh.triangle_edges.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<int, 2> ends{mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3]};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      const auto [place, is_new] = known.try_emplace(ends, static_cast<int>(mesh.edges.size()));
      if (is_new) {
        const int from = ends[0], to = ends[1];
        const bool diagonal = from / mesh.across != to / mesh.across && from % mesh.across != to % mesh.across;
        mesh.edges.push_back({ends, {static_cast<int>(t), -1}, diagonal});
      } else {
        mesh.edges[static_cast<std::size_t>(place->second)].triangles[1] = static_cast<int>(t);
      }
      mesh.triangle_edges[t][k] = place->second;
    }
  }
}

}  // namespace

StripMesh make_strip_mesh(double length, double width, int along, int across, std::array<bool, 2> ghosts) {
  assert(along >= 2 && across >= 2 && length > 0 && width > 0);
  StripMesh mesh;
  mesh.ghosts = {ghosts[0] ? 1 : 0, ghosts[1] ? 1 : 0};
  mesh.columns = along + mesh.ghosts[0] + mesh.ghosts[1];
  mesh.across = across;
  mesh.cell_length = length / (along - 1);
  mesh.cell_width = width / (across - 1);
  for (int i = 0; i < mesh.columns; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.vertices.emplace_back((i - mesh.ghosts[0]) * mesh.cell_length, j * mesh.cell_width - width / 2);
    }
  }
  add_cells(mesh);
  add_edges(mesh);
  return mesh;
}

Vec2 hat_gradient(const StripMesh& mesh, int triangle, int k) {
  const auto& corners = mesh.triangles[static_cast<std::size_t>(triangle)];
  const auto at = [&](int i) {
    return mesh.vertices[static_cast<std::size_t>(corners[static_cast<std::size_t>(i % 3)])];
  };
  const Vec2 across = at(k + 2) - at(k + 1);
  return Vec2(-across.y(), across.x()) / (2 * mesh.triangle_area());
}

}  // namespace wunderlich::baseline::shell
