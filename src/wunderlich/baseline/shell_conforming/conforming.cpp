#include "wunderlich/baseline/shell_conforming/conforming.hpp"

#include "wunderlich/baseline/shell/bending.hpp"

namespace wunderlich::baseline::shell_conforming {

namespace {

constexpr double kShare = 1;

bool is_ghost(const shell::StripMesh& mesh, const shell::Edge& edge) {
  for (const int t : edge.triangles) {
    if (t >= 0 && !mesh.ghost[static_cast<std::size_t>(t)]) return false;
  }
  return true;
}

}  // namespace

shell::Shell make_shell(const geometry::RibbonSpec& strip, const shell::Resolution& resolution) {
  shell::Shell shell;
  shell.strip = strip;
  shell.mesh = shell::make_strip_mesh(strip.length, strip.width, resolution.along, resolution.across, strip.clamped);
  const shell::StripMesh& mesh = shell.mesh;
  shell.flat = mesh.vertices;
  shell::lump_masses(mesh.triangles, shell);
  shell.lengths.resize(2);
  for (const shell::Edge& edge : mesh.edges) {
    if (is_ghost(mesh, edge)) continue;
    const auto end = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(edge.ends[k])]; };
    shell.lengths[edge.diagonal ? 1 : 0].push_back({edge.ends, (end(1) - end(0)).norm()});
  }
  shell.bending =
      shell::bending_matrix(mesh, strip.bending_stiffness, kShare, shell::vertex_stencil, shell.point_count());
  shell.drawn.resize(shell.point_count(), shell.point_count());
  shell.drawn.setIdentity();
  return shell;
}

}  // namespace wunderlich::baseline::shell_conforming
