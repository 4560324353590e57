#include "wunderlich/solver/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/contact/barrier.hpp"
#include "wunderlich/contact/travel.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"
#include "wunderlich/solver/facet_pairs.hpp"

namespace wunderlich::solver {

using contact::PairKind;
using contact::PairPoints;
using geometry::Ribbon;
using Strips = std::span<const StripPlace>;

namespace {

constexpr double kBending = 60;    // barrier over bending, and
constexpr double kWeight = 100;    // over the weight of a segment: light contact, few iterations
constexpr double kNeighbours = 2;  // gaps in the flat pattern up to which parts are neighbours
constexpr double kOpenSeam = 1;    // widths

PairPoints points_of(const SelfPair& pair, const std::vector<Vec3>& corners) {
  PairPoints x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = corners[static_cast<std::size_t>(pair.corner[k])];
  return x;
}

const SelfSurface& surface_of(const SelfContact& problem, int corner) {
  std::size_t s = problem.surfaces.size() - 1;
  while (problem.surfaces[s].first_corner > corner) --s;
  return problem.surfaces[s];
}

const Vec3& flat(const SelfContact& problem, int corner) { return problem.flat[static_cast<std::size_t>(corner)]; }

/// A corner in the flat pattern, in a copy of its strip `lap` lengths further on.
Vec3 flat(const SelfContact& problem, const SelfSurface& surface, int corner, int lap) {
  const Vec3& x = flat(problem, corner);
  return lap == 0 ? x : Vec3(x.x() + lap * surface.period, surface.flip * x.y(), 0);
}

/// Corners of the first part of a pair: the vertex, or one edge.
int first_count(PairKind kind) { return kind == PairKind::vertex_triangle ? 1 : 2; }

bool share_a_corner(const SelfPair& pair) {
  const int first = first_count(pair.kind);
  for (int a = 0; a < first; ++a) {
    for (int b = first; b < 4; ++b) {
      if (pair.corner[static_cast<std::size_t>(a)] == pair.corner[static_cast<std::size_t>(b)]) return true;
    }
  }
  return false;
}

/// Are both parts neighbours in the flat pattern? It tells them apart better than their numbers do: rims shrink to
/// nothing where rulings meet.
bool are_neighbours(const SelfContact& problem, const SelfPair& pair) {
  if (share_a_corner(pair)) return true;
  const double limit = kNeighbours * (problem.reach + problem.thickness);
  const int first = first_count(pair.kind);
  const SelfSurface& surface = surface_of(problem, pair.corner[0]);
  if (&surface != &surface_of(problem, pair.corner[3])) return false;
  const int laps = surface.period > 0 ? 1 : 0;
  PairPoints x;
  for (int k = 0; k < 4; ++k) x[static_cast<std::size_t>(k)] = flat(problem, pair.corner[static_cast<std::size_t>(k)]);
  for (int lap = -laps; lap <= laps; ++lap) {
    for (int k = first; k < 4 && laps > 0; ++k) {
      x[static_cast<std::size_t>(k)] = flat(problem, surface, pair.corner[static_cast<std::size_t>(k)], lap);
    }
    double low[2] = {x[0].x(), x[3].x()}, high[2] = {x[0].x(), x[3].x()};
    for (int k = 1; k < 3; ++k) {
      const int part = k < first ? 0 : 1;
      low[part] = std::min(low[part], x[static_cast<std::size_t>(k)].x());
      high[part] = std::max(high[part], x[static_cast<std::size_t>(k)].x());
    }
    const double apart = std::max(low[0] - high[1], low[1] - high[0]);
    if (lap != 0 && apart < surface.open_seam) return true;
    if (apart > limit) continue;
    if (contact::pair_distance(pair.kind, x) <= limit) return true;
  }
  return false;
}

/// Corners, edges (rulings, then rims) and triangles of all surfaces. A loop's seam is counted once.
void find_parts(const SelfContact& problem, SelfSearch& search) {
  search.corner_parts.clear(), search.edge_parts.clear(), search.triangle_parts.clear();
  for (const SelfSurface& surface : problem.surfaces) {
    const int nodes = surface.period > 0 ? surface.segments : surface.segments + 1;
    for (int i = 0; i < nodes; ++i) {
      const int c = surface.first_corner + 2 * i;
      search.corner_parts.push_back(c), search.corner_parts.push_back(c + 1);
      search.edge_parts.push_back({c, c + 1});
    }
    for (int s = 0; s < surface.segments; ++s) {
      const int c = surface.first_corner + 2 * s;
      search.edge_parts.push_back({c, c + 2}), search.edge_parts.push_back({c + 1, c + 3});
      search.triangle_parts.push_back({c, c + 1, c + 3}), search.triangle_parts.push_back({c, c + 3, c + 2});
    }
  }
}

/// A box about some corners and about where they come from.
template <std::size_t N>
contact::Extent extent(const std::array<int, N>& corners, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                       double margin) {
  contact::Extent out{from[static_cast<std::size_t>(corners[0])], from[static_cast<std::size_t>(corners[0])]};
  for (const int corner : corners) {
    out.add(from[static_cast<std::size_t>(corner)]);
    out.add(to[static_cast<std::size_t>(corner)]);
  }
  out.widen(margin);
  return out;
}

void find_extents(const SelfContact& problem, const std::vector<Vec3>& from, const std::vector<Vec3>& to, double margin,
                  SelfSearch& search) {
  find_parts(problem, search);
  search.corners.clear(), search.edges.clear(), search.triangles.clear();
  for (const int corner : search.corner_parts) search.corners.push_back(extent<1>({corner}, from, to, margin));
  for (const auto& edge : search.edge_parts) search.edges.push_back(extent(edge, from, to, margin));
  for (const auto& triangle : search.triangle_parts) search.triangles.push_back(extent(triangle, from, to, margin));
}

void find_corners(Strips strips, std::vector<Vec3>& corners) {
  corners.clear();
  for (const auto& [ribbon, chain, k] : strips) {
    for (std::size_t i = 0; i < chain.eta.size(); ++i) {
      const Vec3 ruling = k.frame[i].col(1) + chain.eta[i] * k.frame[i].col(2);
      for (const double v : {-0.5 * ribbon.width, 0.5 * ribbon.width}) corners.push_back(k.r[i] + v * ruling);
    }
  }
}

void find_places(Strips strips, const SelfContact& problem, SelfContacts& contacts) {
  find_corners(strips, contacts.corners);
  if (!problem.rubs.empty()) find_material(strips, problem, contacts.material);
}

/// Those of the candidates that feel each other.
void select(const SelfContact& problem, const std::vector<SelfPair>& candidates, SelfContacts& contacts) {
  contacts.pairs.clear();
  for (const SelfPair& pair : candidates) {
    const double distance = contact::pair_distance(pair.kind, points_of(pair, contacts.corners));
    if (distance < problem.reach + problem.thickness) contacts.pairs.push_back(pair);
  }
}

/// May a pair go this way?
bool may_go(const SelfContact& problem, const PairPoints& from, const PairPoints& to, PairKind kind) {
  const double gap = contact::pair_distance(kind, from) - problem.thickness;
  const double least = contact::kLeastShare * std::min(gap, problem.reach);
  double way = 0;
  for (std::size_t a = 0; a < 4; ++a) way = std::max(way, (to[a] - from[a]).squaredNorm());
  if (gap - 2 * std::sqrt(way) > least) return true;
  return contact::free_share(kind, from, to, problem.thickness, least / gap) >= 1;
}

using Systems = std::span<math::ChainSystem* const>;

}  // namespace

contact::Gap gap_of(const SelfContact& problem, const SelfPair& pair) {
  const auto length = [&](int a, int b) {
    return (flat(problem, pair.corner[static_cast<std::size_t>(a)]) -
            flat(problem, pair.corner[static_cast<std::size_t>(b)]))
        .squaredNorm();
  };
  const double parallel = pair.kind == PairKind::edge_edge ? kParallel * length(0, 1) * length(2, 3) : 0;
  return {problem.reach, problem.thickness, parallel};
}

void place_self(const Ribbon& loop, const constraint::Surroundings& surroundings, double reach, bool closed,
                const std::vector<double>& eta, SelfContact& problem) {
  const constraint::Contact& contact = surroundings.contact;
  problem.reach = contact.self ? reach : 0;
  if (!contact.self) return;
  problem.thickness = contact.thickness;
  problem.friction = contact.friction;
  const double weight = loop.area_density * surroundings.gravity.norm() * loop.width * loop.length / loop.segments;
  problem.stiffness = std::max(kBending * loop.bending_stiffness / loop.width, kWeight * weight) / problem.reach;
  SelfSurface surface;
  surface.segments = loop.segments;
  surface.period = loop.is_loop() ? loop.length : 0;
  surface.flip = loop.is_loop() ? loop.seam_sign() : 1;
  surface.open_seam = loop.is_loop() && !closed ? kOpenSeam * loop.width : 0;
  problem.surfaces.assign(1, surface);
  problem.flat.clear();
  for (std::size_t i = 0; i < eta.size(); ++i) {
    for (const double v : {-0.5 * loop.width, 0.5 * loop.width}) {
      problem.flat.emplace_back(loop.node_u[i] + v * eta[i], v, 0);
    }
  }
}

void place_beside(const SelfContact& other, SelfContact& all) {
  all.reach = all.surfaces.empty() ? other.reach : std::min(all.reach, other.reach);
  all.thickness = std::max(all.thickness, other.thickness);
  all.stiffness = std::max(all.stiffness, other.stiffness);
  all.friction = std::max(all.friction, other.friction);
  for (SelfSurface surface : other.surfaces) {
    surface.first_corner += static_cast<int>(all.flat.size());
    all.surfaces.push_back(surface);
  }
  all.flat.insert(all.flat.end(), other.flat.begin(), other.flat.end());
}

void find_candidates(const SelfContact& problem, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                     SelfSearch& search) {
  find_extents(problem, from, to, 0.5 * (problem.reach + problem.thickness), search);
  const contact::Grid grid = contact::grid_over(search.triangles);
  contact::build_tree(search.corners, grid, search.corner_tree);
  contact::build_tree(search.edges, grid, search.edge_tree);
  contact::build_tree(search.triangles, grid, search.triangle_tree);
  search.candidates.clear();
  const auto take = [&](const SelfPair& pair) {
    if (!are_neighbours(problem, pair)) search.candidates.push_back(pair);
  };
  contact::find_near(search.corner_tree, search.triangle_tree, search.near);
  for (const auto& [corner, triangle] : search.near) {
    const auto& t = search.triangle_parts[static_cast<std::size_t>(triangle)];
    take({PairKind::vertex_triangle, {search.corner_parts[static_cast<std::size_t>(corner)], t[0], t[1], t[2]}});
  }
  contact::find_near(search.edge_tree, search.near);
  for (const auto& [a, b] : search.near) {
    const auto& ea = search.edge_parts[static_cast<std::size_t>(a)];
    const auto& eb = search.edge_parts[static_cast<std::size_t>(b)];
    take({PairKind::edge_edge, {ea[0], ea[1], eb[0], eb[1]}});
  }
}

void find_pairs(Strips strips, const SelfContact& problem, SelfSearch& search, SelfContacts& contacts) {
  find_places(strips, problem, contacts);
  find_candidates(problem, contacts.corners, contacts.corners, search);
  select(problem, search.candidates, contacts);
}

bool travel(Strips strips, const SelfContact& problem, const SelfContacts& from, SelfSearch& search, SelfContacts& to) {
  find_places(strips, problem, to);
  for (const Vec3& corner : to.corners) {
    if (!corner.allFinite()) return false;
  }
  find_candidates(problem, from.corners, to.corners, search);
  for (const SelfPair& pair : search.candidates) {
    if (!may_go(problem, points_of(pair, from.corners), points_of(pair, to.corners), pair.kind)) return false;
  }
  select(problem, search.candidates, to);
  return true;
}

double self_energy(const SelfContact& problem, const SelfContacts& contacts) {
  double sum = 0;
  for (const SelfPair& pair : contacts.pairs) {
    sum += contact::pair_value(pair.kind, points_of(pair, contacts.corners), gap_of(problem, pair));
  }
  return problem.stiffness * sum;
}

void add_self_contact(Strips strips, const SelfContact& problem, const SelfContacts& contacts, Systems systems,
                      std::vector<math::ChainCoupling>& between) {
  between.clear();
  if (contacts.pairs.empty()) return;
  CornerSums sums;
  clear(contacts.corners.size(), sums);
  for (const SelfPair& pair : contacts.pairs) {
    const PairPoints x = points_of(pair, contacts.corners);
    const contact::PairEnergy e = contact::pair_energy(pair.kind, x, gap_of(problem, pair));
    const contact::Mat12 stiff = problem.stiffness * e.second * e.along * e.along.transpose();
    const contact::Mat12 whole = problem.stiffness * e.hessian;
    add(pair.corner, problem.stiffness * e.gradient, stiff, whole - stiff, sums);
  }
  hand_over(strips, sums, contacts.corners, false, systems, between);
}

double smallest_distance(const SelfContact& problem, const SelfContacts& contacts) {
  double least = problem.reach;
  for (const SelfPair& pair : contacts.pairs) {
    least = std::min(least, contact::pair_distance(pair.kind, points_of(pair, contacts.corners)) - problem.thickness);
  }
  return least;
}

int count_crossings(const SelfContact& problem, const SelfContacts& contacts, SelfSearch& search) {
  find_extents(problem, contacts.corners, contacts.corners, 0, search);
  const contact::Grid grid = contact::grid_over(search.triangles);
  contact::build_tree(search.edges, grid, search.edge_tree);
  contact::build_tree(search.triangles, grid, search.triangle_tree);
  contact::find_near(search.edge_tree, search.triangle_tree, search.near);
  int count = 0;
  for (const auto& [edge, triangle] : search.near) {
    const auto& e = search.edge_parts[static_cast<std::size_t>(edge)];
    const auto& t = search.triangle_parts[static_cast<std::size_t>(triangle)];
    const SelfPair first{PairKind::vertex_triangle, {e[0], t[0], t[1], t[2]}};
    const SelfPair second{PairKind::vertex_triangle, {e[1], t[0], t[1], t[2]}};
    if (are_neighbours(problem, first) || are_neighbours(problem, second)) continue;
    const auto at = [&](int corner) -> const Vec3& { return contacts.corners[static_cast<std::size_t>(corner)]; };
    count += contact::pierces(at(e[0]), at(e[1]), at(t[0]), at(t[1]), at(t[2])) ? 1 : 0;
  }
  return count;
}

}  // namespace wunderlich::solver
