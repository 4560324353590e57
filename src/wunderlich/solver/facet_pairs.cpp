#include "wunderlich/solver/facet_pairs.hpp"

namespace wunderlich::solver {

using contact::Extent;
using contact::PairPoints;
using contact::TriangleMesh;

PairPoints points_of(const FacetPair& pair, const PairPoints& facet, const TriangleMesh& mesh) {
  PairPoints x;
  for (std::size_t k = 0; k < 4; ++k) {
    x[k] = pair.corner[k] >= 0 ? facet[static_cast<std::size_t>(pair.corner[k])]
                               : mesh.vertices[static_cast<std::size_t>(pair.vertex[k])];
  }
  return x;
}

void add_parts(std::size_t s, PairSearch& search) {
  for (int corner = s == 0 ? 0 : 2; corner < 4; ++corner) search.corners.push_back({s, {corner, -1, -1}});
  if (s == 0) search.edges.push_back({s, {0, 1, -1}});
  search.edges.push_back({s, {2, 3, -1}});
  search.edges.push_back({s, {0, 2, -1}});
  search.edges.push_back({s, {1, 3, -1}});
  search.triangles.push_back({s, {0, 1, 2}});
  search.triangles.push_back({s, {1, 3, 2}});
}

Extent box_of(const FacetPart& part, const PairPoints& facet) {
  const auto at = [&](std::size_t k) -> const Vec3& { return facet[static_cast<std::size_t>(part.corner[k])]; };
  Extent box{at(0), at(0)};
  for (std::size_t k = 1; k < 3 && part.corner[k] >= 0; ++k) box.add(at(k));
  return box;
}

Extent box_of(const PairPoints& facet) {
  Extent box{facet[0], facet[0]};
  for (std::size_t k = 1; k < 4; ++k) box.add(facet[k]);
  return box;
}

}  // namespace wunderlich::solver
