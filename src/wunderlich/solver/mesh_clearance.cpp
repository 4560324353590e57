// What solids of triangles leave free: ways, and where a strip may be.
#include "wunderlich/contact/barrier.hpp"
#include "wunderlich/contact/travel.hpp"
#include "wunderlich/solver/chain_mesh_contact.hpp"

namespace wunderlich::solver {

using contact::Extent;
using contact::PairPoints;
using contact::TriangleMesh;

namespace {}  // namespace

bool mesh_may_go(const MeshProblem& problem, const MeshPoints& from, const MeshPoints& to, PairSearch& search) {
  if (problem.solids.empty()) return true;
  const std::size_t n = from.facets.size() / problem.solids.size();
  const double least = contact::kLeastShare * problem.distance;  // what is left of a gap that was large
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    if (from.placed[i] == 0 || to.placed[i] == 0) {
      Extent way = from.strip, solid = from.extents[i];
      way.add(to.strip);
      solid.add(to.extents[i]);
      way.widen(problem.thickness + least);
      if (!way.overlaps(solid)) continue;
      return false;  // a shorter way brings it near enough to be looked at
    }
    const TriangleMesh& mesh = *problem.solids[i].mesh;
    const PairPoints *const facets0 = from.facets.data() + i * n, *const facets1 = to.facets.data() + i * n;
    const auto swept = [&](Extent box, const Extent& end) {
      box.add(end);
      box.widen(problem.thickness + least);
      return box;
    };
    gather(n, search,
           [&](std::size_t s) { return swept(box_of(facets0[s]), box_of(facets1[s])).overlaps(mesh.whole); });
    const auto box = [&](const FacetPart& part) {
      return swept(box_of(part, facets0[part.segment]), box_of(part, facets1[part.segment]));
    };
    bool may = true;
    match_all(i, mesh, search, box, [&](const FacetPair& pair) {
      if (!may) return;
      const PairPoints x0 = points_of(pair, facets0[pair.segment], mesh);
      const PairPoints x1 = points_of(pair, facets1[pair.segment], mesh);
      const double gap = contact::pair_distance(pair.kind, x0) - problem.thickness;
      const double leave = gap > problem.distance ? least / gap : contact::kLeastShare;
      may = contact::free_share(pair.kind, x0, x1, problem.thickness, leave) >= 1;
    });
    if (!may) return false;
  }
  return true;
}

bool is_inside_mesh(const MeshProblem& problem, const MeshPoints& points) {
  PairSearch search;
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    if (points.placed[i] == 0) continue;
    const TriangleMesh& mesh = *problem.solids[i].mesh;
    const std::size_t n = points.facets.size() / problem.solids.size();
    const PairPoints* const facets = points.facets.data() + i * n;
    // What no edge leaves or enters is in or out as a whole.
    if (contact::winding(mesh, facets[0][0]) > 0.5) return true;
    gather(n, search, [&](std::size_t s) { return box_of(facets[s]).overlaps(mesh.whole); });
    const auto box = [&](const FacetPart& part) { return box_of(part, facets[part.segment]); };
    const auto corner = [&](const FacetPart& part, std::size_t k) -> const Vec3& {
      return facets[part.segment][static_cast<std::size_t>(part.corner[k])];
    };
    const auto vertex = [&](int v) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
    bool cut = false;
    match(search.edges, mesh.triangle_tree, search, box, [&](const FacetPart& part, std::size_t t) {
      const auto& triangle = mesh.triangles[t];
      cut = cut || contact::pierces(corner(part, 0), corner(part, 1), vertex(triangle[0]), vertex(triangle[1]),
                                    vertex(triangle[2]));
    });
    match(search.triangles, mesh.ridge_tree, search, box, [&](const FacetPart& part, std::size_t e) {
      const auto& ridge = mesh.ridges[e];
      cut = cut ||
            contact::pierces(vertex(ridge[0]), vertex(ridge[1]), corner(part, 0), corner(part, 1), corner(part, 2));
    });
    if (cut) return true;
  }
  return false;
}

}  // namespace wunderlich::solver
