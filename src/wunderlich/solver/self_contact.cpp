#include "wunderlich/solver/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/contact/travel.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"

namespace wunderlich::solver {

using contact::PairKind;
using contact::PairPoints;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kBending = 60;      // barrier over bending, and
constexpr double kWeight = 100;      // over the weight of a segment: light contact, few iterations
constexpr double kLeastShare = 0.1;  // of a gap that one step of Newton's leaves
constexpr double kNeighbours = 2;    // gaps in the flat pattern up to which parts are neighbours
constexpr double kParallel = 1e-3;   // of |e1|^2 |e2|^2: edges that count as parallel   @eq Li2020:18
constexpr double kOpenSeam = 1;      // widths

PairPoints points_of(const SelfPair& pair, const std::vector<Vec3>& corners) {
  PairPoints x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = corners[static_cast<std::size_t>(pair.corner[k])];
  return x;
}

/// A corner in the flat pattern, in a copy of the strip `lap` lengths further on.
Vec3 flat(const Ribbon& ribbon, const SelfContact& problem, int corner, int lap) {
  const auto node = static_cast<std::size_t>(corner / 2);
  const double v = (corner % 2 == 0 ? -0.5 : 0.5) * ribbon.width;
  const double turned = lap == 0 ? v : problem.flip * v;
  return {ribbon.node_u[node] + v * problem.eta[node] + lap * problem.period, turned, 0};
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
bool are_neighbours(const Ribbon& ribbon, const SelfContact& problem, const SelfPair& pair) {
  if (share_a_corner(pair)) return true;
  const double limit = kNeighbours * (problem.reach + problem.thickness);
  const int first = first_count(pair.kind), laps = problem.period > 0 ? 1 : 0;
  PairPoints x;
  for (int k = 0; k < 4; ++k)
    x[static_cast<std::size_t>(k)] = flat(ribbon, problem, pair.corner[static_cast<std::size_t>(k)], 0);
  for (int lap = -laps; lap <= laps; ++lap) {
    for (int k = first; k < 4 && laps > 0; ++k) {
      x[static_cast<std::size_t>(k)] = flat(ribbon, problem, pair.corner[static_cast<std::size_t>(k)], lap);
    }
    double low[2] = {x[0].x(), x[3].x()}, high[2] = {x[0].x(), x[3].x()};
    for (int k = 1; k < 3; ++k) {
      const int part = k < first ? 0 : 1;
      low[part] = std::min(low[part], x[static_cast<std::size_t>(k)].x());
      high[part] = std::max(high[part], x[static_cast<std::size_t>(k)].x());
    }
    const double apart = std::max(low[0] - high[1], low[1] - high[0]);
    if (lap != 0 && apart < problem.open_seam) return true;
    if (apart > limit) continue;
    if (contact::pair_distance(pair.kind, x) <= limit) return true;
  }
  return false;
}

/// The surface's parts: corners, edges (rulings, then rims), triangles. A loop's seam is counted once.
struct Parts {
  int segments, nodes;
  explicit Parts(const Ribbon& ribbon, const SelfContact& problem)
      : segments(ribbon.segments), nodes(problem.period > 0 ? ribbon.segments : ribbon.segments + 1) {}
  int corners() const { return 2 * nodes; }
  int edges() const { return nodes + 2 * segments; }
  int triangles() const { return 2 * segments; }
  std::array<int, 2> edge(int k) const {
    if (k < nodes) return {2 * k, 2 * k + 1};
    const int side = (k - nodes) % 2, s = (k - nodes) / 2;
    return {2 * s + side, 2 * s + 2 + side};
  }
  std::array<int, 3> triangle(int k) const {
    const int first = 2 * (k / 2);
    return k % 2 == 0 ? std::array<int, 3>{first, first + 1, first + 3}
                      : std::array<int, 3>{first, first + 3, first + 2};
  }
};

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

void find_extents(const Parts& parts, const std::vector<Vec3>& from, const std::vector<Vec3>& to, double margin,
                  SelfSearch& search) {
  search.corners.clear(), search.edges.clear(), search.triangles.clear();
  for (int k = 0; k < parts.corners(); ++k) search.corners.push_back(extent<1>({k}, from, to, margin));
  for (int k = 0; k < parts.edges(); ++k) search.edges.push_back(extent(parts.edge(k), from, to, margin));
  for (int k = 0; k < parts.triangles(); ++k) search.triangles.push_back(extent(parts.triangle(k), from, to, margin));
}

/// All pairs that may come within reach on the way, but for neighbours.
void find_candidates(const Ribbon& ribbon, const SelfContact& problem, const std::vector<Vec3>& from,
                     const std::vector<Vec3>& to, SelfSearch& search) {
  const Parts parts(ribbon, problem);
  find_extents(parts, from, to, 0.5 * (problem.reach + problem.thickness), search);
  const contact::Grid grid = contact::grid_over(search.triangles);
  contact::build_tree(search.corners, grid, search.corner_tree);
  contact::build_tree(search.edges, grid, search.edge_tree);
  contact::build_tree(search.triangles, grid, search.triangle_tree);
  search.candidates.clear();
  const auto take = [&](const SelfPair& pair) {
    if (!are_neighbours(ribbon, problem, pair)) search.candidates.push_back(pair);
  };
  contact::find_near(search.corner_tree, search.triangle_tree, search.near);
  for (const auto& [corner, triangle] : search.near) {
    const auto t = parts.triangle(triangle);
    take({PairKind::vertex_triangle, {corner, t[0], t[1], t[2]}});
  }
  contact::find_near(search.edge_tree, search.near);
  for (const auto& [a, b] : search.near) {
    const auto ea = parts.edge(a), eb = parts.edge(b);
    take({PairKind::edge_edge, {ea[0], ea[1], eb[0], eb[1]}});
  }
}

void find_corners(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, std::vector<Vec3>& corners) {
  corners.clear();
  for (std::size_t i = 0; i < chain.eta.size(); ++i) {
    const Vec3 ruling = k.frame[i].col(1) + chain.eta[i] * k.frame[i].col(2);
    for (const double v : {-0.5 * ribbon.width, 0.5 * ribbon.width}) corners.push_back(k.r[i] + v * ruling);
  }
}

/// Those of the candidates that feel each other.
void select(const SelfContact& problem, const std::vector<SelfPair>& candidates, SelfContacts& contacts) {
  contacts.pairs.clear();
  for (const SelfPair& pair : candidates) {
    const double distance = contact::pair_distance(pair.kind, points_of(pair, contacts.corners));
    if (distance < problem.reach + problem.thickness) contacts.pairs.push_back(pair);
  }
}

contact::Gap gap_of(const Ribbon& ribbon, const SelfContact& problem, const SelfPair& pair) {
  const auto length = [&](int a, int b) {
    return (flat(ribbon, problem, pair.corner[static_cast<std::size_t>(a)], 0) -
            flat(ribbon, problem, pair.corner[static_cast<std::size_t>(b)], 0))
        .squaredNorm();
  };
  const double parallel = pair.kind == PairKind::edge_edge ? kParallel * length(0, 1) * length(2, 3) : 0;
  return {problem.reach, problem.thickness, parallel};
}

/// May a pair go this way?
bool may_go(const SelfContact& problem, const PairPoints& from, const PairPoints& to, PairKind kind) {
  const double gap = contact::pair_distance(kind, from) - problem.thickness;
  const double least = kLeastShare * std::min(gap, problem.reach);
  double way = 0;
  for (std::size_t a = 0; a < 4; ++a) way = std::max(way, (to[a] - from[a]).squaredNorm());
  if (gap - 2 * std::sqrt(way) > least) return true;
  return contact::free_share(kind, from, to, problem.thickness, least / gap) >= 1;
}

/// Second derivatives between corners, gathered over all pairs.
struct Gather {
  struct Block {
    int a, b;
    Mat3 hessian, geometric;
  };
  std::vector<Block> blocks;

  void add(const SelfPair& pair, const contact::Mat12& hessian, const contact::Mat12& geometric) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int ca = pair.corner[static_cast<std::size_t>(a)], cb = pair.corner[static_cast<std::size_t>(b)];
        if (ca <= cb)
          blocks.push_back({ca, cb, hessian.block<3, 3>(3 * a, 3 * b), geometric.block<3, 3>(3 * a, 3 * b)});
      }
    }
  }

  void merge() {
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](const Block& x, const Block& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    std::size_t kept = 0;
    for (std::size_t k = 1; k < blocks.size(); ++k) {
      if (blocks[kept].a == blocks[k].a && blocks[kept].b == blocks[k].b) {
        blocks[kept].hessian += blocks[k].hessian;
        blocks[kept].geometric += blocks[k].geometric;
      } else {
        blocks[++kept] = blocks[k];
      }
    }
    if (!blocks.empty()) blocks.resize(kept + 1);
  }
};

}  // namespace

void place_self(const Ribbon& loop, const constraint::Surroundings& surroundings, double reach, bool closed,
                const std::vector<double>& eta, SelfContact& problem) {
  const constraint::Contact& contact = surroundings.contact;
  problem.reach = contact.self ? reach : 0;
  if (!contact.self) return;
  problem.thickness = contact.thickness;
  const double weight = loop.area_density * surroundings.gravity.norm() * loop.width * loop.length / loop.segments;
  problem.stiffness = std::max(kBending * loop.bending_stiffness / loop.width, kWeight * weight) / problem.reach;
  problem.period = loop.is_loop() ? loop.length : 0;
  problem.flip = loop.is_loop() ? loop.seam_sign() : 1;
  problem.open_seam = loop.is_loop() && !closed ? kOpenSeam * loop.width : 0;
  problem.eta = eta;
}

void find_pairs(const Ribbon& ribbon, const SelfContact& problem, const Chain& chain, const Kinematics& kinematics,
                SelfSearch& search, SelfContacts& contacts) {
  find_corners(ribbon, chain, kinematics, contacts.corners);
  find_candidates(ribbon, problem, contacts.corners, contacts.corners, search);
  select(problem, search.candidates, contacts);
}

bool travel(const Ribbon& ribbon, const SelfContact& problem, const SelfContacts& from, const Chain& chain,
            const Kinematics& kinematics, SelfSearch& search, SelfContacts& to) {
  find_corners(ribbon, chain, kinematics, to.corners);
  for (const Vec3& corner : to.corners) {
    if (!corner.allFinite()) return false;
  }
  find_candidates(ribbon, problem, from.corners, to.corners, search);
  for (const SelfPair& pair : search.candidates) {
    if (!may_go(problem, points_of(pair, from.corners), points_of(pair, to.corners), pair.kind)) return false;
  }
  select(problem, search.candidates, to);
  return true;
}

double self_energy(const Ribbon& ribbon, const SelfContact& problem, const SelfContacts& contacts) {
  double sum = 0;
  for (const SelfPair& pair : contacts.pairs) {
    sum += contact::pair_value(pair.kind, points_of(pair, contacts.corners), gap_of(ribbon, problem, pair));
  }
  return problem.stiffness * sum;
}

void add_self_contact(const Ribbon& ribbon, const SelfContact& problem, const Kinematics& k,
                      const SelfContacts& contacts, math::ChainSystem& system) {
  if (contacts.pairs.empty()) return;
  Gather gather;
  std::vector<Vec3> force(contacts.corners.size(), Vec3::Zero());
  for (const SelfPair& pair : contacts.pairs) {
    const PairPoints x = points_of(pair, contacts.corners);
    const contact::PairEnergy e = contact::pair_energy(pair.kind, x, gap_of(ribbon, problem, pair));
    const contact::Mat12 stiff = problem.stiffness * e.second * e.along * e.along.transpose();
    const contact::Mat12 whole = problem.stiffness * e.hessian;
    gather.add(pair, stiff, whole - stiff);
    for (int a = 0; a < 4; ++a) {
      force[static_cast<std::size_t>(pair.corner[static_cast<std::size_t>(a)])] +=
          problem.stiffness * e.gradient.segment<3>(3 * a);
    }
  }
  gather.merge();
  std::vector<int> point(contacts.corners.size(), -1);
  for (const Gather::Block& block : gather.blocks) {
    if (block.a != block.b) continue;  // each corner has a block with itself
    const auto corner = static_cast<std::size_t>(block.a);
    const std::size_t node = corner / 2;
    const double v = (corner % 2 == 0 ? -0.5 : 0.5) * ribbon.width;
    const bool turns = geometry::eta_is_free(ribbon, static_cast<int>(node));
    point[corner] = static_cast<int>(system.points.size());
    system.points.push_back({static_cast<int>(node), contacts.corners[corner] - k.r[node],
                             turns ? Vec3(v * k.frame[node].col(2)) : Vec3::Zero(), force[corner]});
  }
  for (const Gather::Block& block : gather.blocks) {
    system.couplings.push_back({point[static_cast<std::size_t>(block.a)], point[static_cast<std::size_t>(block.b)],
                                block.hessian, block.geometric});
  }
}

double smallest_distance(const SelfContact& problem, const SelfContacts& contacts) {
  double least = problem.reach;
  for (const SelfPair& pair : contacts.pairs) {
    least = std::min(least, contact::pair_distance(pair.kind, points_of(pair, contacts.corners)) - problem.thickness);
  }
  return least;
}

int count_crossings(const Ribbon& ribbon, const SelfContact& problem, const SelfContacts& contacts,
                    SelfSearch& search) {
  const Parts parts(ribbon, problem);
  find_extents(parts, contacts.corners, contacts.corners, 0, search);
  const contact::Grid grid = contact::grid_over(search.triangles);
  contact::build_tree(search.edges, grid, search.edge_tree);
  contact::build_tree(search.triangles, grid, search.triangle_tree);
  contact::find_near(search.edge_tree, search.triangle_tree, search.near);
  int count = 0;
  for (const auto& [edge, triangle] : search.near) {
    const auto e = parts.edge(edge);
    const auto t = parts.triangle(triangle);
    const SelfPair first{PairKind::vertex_triangle, {e[0], t[0], t[1], t[2]}};
    const SelfPair second{PairKind::vertex_triangle, {e[1], t[0], t[1], t[2]}};
    if (are_neighbours(ribbon, problem, first) || are_neighbours(ribbon, problem, second)) continue;
    const auto at = [&](int corner) -> const Vec3& { return contacts.corners[static_cast<std::size_t>(corner)]; };
    count += contact::pierces(at(e[0]), at(e[1]), at(t[0]), at(t[1]), at(t[2])) ? 1 : 0;
  }
  return count;
}

}  // namespace wunderlich::solver
