/// Parts of facets and of solids of triangles that may be near each other.
#pragma once

#include "wunderlich/contact/pair.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"

namespace wunderlich::solver {

/// Of |e1|^2 |e2|^2: edges whose cross product squared is less count as parallel, and their barrier is weakened.
/// @eq Li2020:18
inline constexpr double kParallel = 1e-3;

/// Part of a facet with part of a solid. Corners: 0, 1 at the segment's start, 2, 3 at its end, even ones at -w/2.
struct FacetPair {
  contact::PairKind kind;
  std::size_t solid, segment;
  std::array<int, 4> corner;  ///< which of the pair's points are corners of the facet, or -1
  std::array<int, 4> vertex;  ///< and which are vertices of the mesh
  double distance;            ///< [m]
};

/// Part of a facet: its segment and corners, those beyond the last -1.
struct FacetPart {
  std::size_t segment;
  std::array<int, 3> corner;
};

/// Buffers of the search for pairs, kept from one to the next.
struct PairSearch {
  std::vector<FacetPart> corners, edges, triangles;
  std::vector<contact::Extent> extents;
  contact::ExtentTree tree;
  std::vector<contact::Near> near;
};

/// The box around a part of a facet, and around a facet, of its corners [m].
contact::Extent box_of(const FacetPart& part, const contact::PairPoints& facet);
contact::Extent box_of(const contact::PairPoints& facet);

/// The four points of a pair, in the solid's own frame.
contact::PairPoints points_of(const FacetPair& pair, const contact::PairPoints& facet,
                              const contact::TriangleMesh& mesh);

/// Parts of a segment's facet. The ruling at its start belongs to the segment before, if there is one.
void add_parts(std::size_t segment, PairSearch& search);

/// Calls visit(part, index in the tree) for all of the parts whose boxes, by box(part), overlap with those of a tree.
template <class Box, class Visit>
void match(const std::vector<FacetPart>& parts, const contact::ExtentTree& tree, PairSearch& search, const Box& box,
           const Visit& visit) {
  search.extents.clear();
  for (const FacetPart& part : parts) search.extents.push_back(box(part));
  contact::build_tree(search.extents, tree.grid, search.tree);
  contact::find_near(search.tree, tree, search.near);
  for (const auto& [i, j] : search.near) visit(parts[static_cast<std::size_t>(i)], static_cast<std::size_t>(j));
}

/// Calls visit(pair) for everything that may be near on one solid. box(part): where a part can be.
template <class Box, class Visit>
void match_all(std::size_t solid, const contact::TriangleMesh& mesh, PairSearch& search, const Box& box,
               const Visit& visit) {
  FacetPair pair{contact::PairKind::vertex_triangle, solid, 0, {}, {}, 0};
  match(search.corners, mesh.triangle_tree, search, box, [&](const FacetPart& part, std::size_t i) {
    const auto& t = mesh.triangles[i];
    pair.segment = part.segment;
    pair.corner = {part.corner[0], -1, -1, -1};
    pair.vertex = {-1, t[0], t[1], t[2]};
    visit(pair);
  });
  match(search.triangles, mesh.peak_tree, search, box, [&](const FacetPart& part, std::size_t i) {
    pair.segment = part.segment;
    pair.corner = {-1, part.corner[0], part.corner[1], part.corner[2]};
    pair.vertex = {mesh.peaks[i], -1, -1, -1};
    visit(pair);
  });
  pair.kind = contact::PairKind::edge_edge;
  match(search.edges, mesh.ridge_tree, search, box, [&](const FacetPart& part, std::size_t i) {
    const auto& ridge = mesh.ridges[i];
    pair.segment = part.segment;
    pair.corner = {part.corner[0], part.corner[1], -1, -1};
    pair.vertex = {-1, -1, ridge[0], ridge[1]};
    visit(pair);
  });
}

/// Parts of the segments for which near(segment's index) holds.
template <class Near>
void gather(std::size_t segments, PairSearch& search, const Near& near) {
  search.corners.clear();
  search.edges.clear();
  search.triangles.clear();
  for (std::size_t s = 0; s < segments; ++s) {
    if (near(s)) add_parts(s, search);
  }
}

}  // namespace wunderlich::solver
