#include "wunderlich/math/chain_sparse.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace wunderlich::math {

namespace {

using Parts = std::span<const ChainPart>;
using Couplings = std::vector<ChainCoupling>;

int node_of(const ChainSystem& system, int point) { return system.points[static_cast<std::size_t>(point)].node; }

/// Everything that decides which entries there are, and in which order they come.
void describe(Parts parts, const Couplings& between, std::vector<int>& key) {
  key.clear();
  const auto note = [&](const PointCoupling& coupling) { key.push_back(coupling.a), key.push_back(coupling.b); };
  for (const ChainPart& part : parts) {
    const ChainSystem& system = *part.system;
    key.push_back(static_cast<int>(system.links.size()));
    for (const bool fixed : system.base_fixed) key.push_back(fixed ? 1 : 0);
    key.push_back(static_cast<int>(system.turns.size()));
    const auto nodes = [&](const auto& terms) {
      key.push_back(static_cast<int>(terms.size()));
      for (const auto& term : terms) key.push_back(term.node);
    };
    nodes(system.rows), nodes(system.pose_terms), nodes(system.surfaces), nodes(system.points);
    key.push_back(static_cast<int>(system.couplings.size()));
    for (const PointCoupling& coupling : system.couplings) note(coupling);
  }
  for (const ChainCoupling& coupling : between) {
    key.push_back(coupling.chain[0]), key.push_back(coupling.chain[1]);
    note(coupling.points);
  }
}

/// Order in which the nodes of all chains, numbered through, are eliminated: of least fill on their graph.
std::vector<int> elimination_order(Parts parts, const Couplings& between) {
  std::vector<Eigen::Triplet<double>> edges;
  const auto join = [&](int a, int b) { edges.emplace_back(a, b, 1.0), edges.emplace_back(b, a, 1.0); };
  std::vector<int> first;
  int count = 0;
  for (const ChainPart& part : parts) {
    const auto links = static_cast<int>(part.system->links.size());
    for (int i = 0; i < links; ++i) {
      edges.emplace_back(count + i, count + i, 1.0);
      if (i > 0) join(count + i, count + i - 1);
    }
    for (const PointCoupling& coupling : part.system->couplings) {
      join(count + node_of(*part.system, coupling.a), count + node_of(*part.system, coupling.b));
    }
    first.push_back(count);
    count += links;
  }
  for (const auto& [chain, points] : between) {
    const auto a = static_cast<std::size_t>(chain[0]), b = static_cast<std::size_t>(chain[1]);
    join(first[a] + node_of(*parts[a].system, points.a), first[b] + node_of(*parts[b].system, points.b));
  }
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(edges.begin(), edges.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  return {order.indices().data(), order.indices().data() + count};
}

/// Numbers the unknowns: node by node, poses and coordinates before the multipliers that need them; rows last.
void place_unknowns(Parts parts, const Couplings& between, SparseWorkspace& work) {
  int next = 0;
  const auto take = [&](int size) { return std::exchange(next, next + size); };
  std::vector<std::pair<std::size_t, int>> nodes;  // chain and node by number
  work.chains.resize(parts.size());
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const std::size_t count = parts[c].system->links.size();
    work.chains[c].places.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) nodes.emplace_back(c, static_cast<int>(i));
  }
  for (const int number : elimination_order(parts, between)) {
    const auto [c, node] = nodes[static_cast<std::size_t>(number)];
    NodePlaces& at = work.chains[c].places[static_cast<std::size_t>(node)];
    at.v = take(3);
    if (node == 0) work.chains[c].theta_base = take(3);
    at.theta = take(3);
    at.u = take(2);
    at.turn = take(3);
    if (node > 0) at.move = take(3);
  }
  for (std::size_t c = 0; c < parts.size(); ++c) {
    work.chains[c].first_row = take(static_cast<int>(parts[c].system->rows.size()));
  }
  work.size = next;
  work.fixed.assign(static_cast<std::size_t>(next), 0);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto& held = parts[k].system->base_fixed;
    for (int c = 0; c < 3; ++c) {
      work.fixed[static_cast<std::size_t>(work.chains[k].places[0].v + c)] = held[static_cast<std::size_t>(c)];
      work.fixed[static_cast<std::size_t>(work.chains[k].theta_base + c)] = held[static_cast<std::size_t>(3 + c)];
    }
  }
}

/// Solves, and improves the solution where it needs it: pivots are taken as they come.
bool solve(SparseWorkspace& work) {
  constexpr double kExact = 1e-12, kUseful = 1e-6;  // of the right-hand side
  constexpr int kMostPasses = 3;
  const auto matrix = work.matrix.lower().selfadjointView<Eigen::Lower>();
  const double size = work.right.norm();
  work.solution = work.right;
  solve(work.factor, work.solution);
  for (int pass = 0;; ++pass) {
    work.rest = work.right;
    work.rest.noalias() -= matrix * work.solution;
    const double rest = work.rest.norm();
    if (rest <= kExact * size) return true;
    if (pass == kMostPasses || !(rest < std::numeric_limits<double>::infinity())) return rest <= kUseful * size;
    solve(work.factor, work.rest);
    work.solution += work.rest;
  }
}

void read_step(const ChainSystem& system, const ChainUnknowns& chain, const Eigen::VectorXd& x, ChainStep& step) {
  step.base << x.segment<3>(chain.places[0].v), x.segment<3>(chain.theta_base);
  step.u.resize(system.links.size());
  step.v.resize(system.links.size());
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    step.v[i] = x.segment<3>(chain.places[i].v);
    step.u[i] = x.segment<2>(chain.places[i].u);
  }
  step.multiplier.resize(system.rows.size());
  for (std::size_t k = 0; k < system.rows.size(); ++k) {
    step.multiplier[k] = x[chain.first_row + static_cast<Eigen::Index>(k)];
  }
}

/// Each chain's forces, and the exact gradient.
void find_gradients(Parts parts, SparseWorkspace& work) {
  for (std::size_t c = 0; c < parts.size(); ++c) {
    std::vector<NodeWrench>& wrenches = work.chains[c].wrench;
    find_wrenches(*parts[c].system, wrenches, parts[c].work->base_gradient);
    std::vector<Vec2>& gradient = parts[c].work->gradient;
    gradient.resize(wrenches.size());
    for (std::size_t i = 0; i < wrenches.size(); ++i) gradient[i] = wrenches[i].gradient;
  }
}

/// Negative pivots that are modes: one belongs to each multiplier.
int count_negative(Parts parts, const Eigen::VectorXd& pivots) {
  auto count = static_cast<int>((pivots.array() < 0).count());
  for (const ChainPart& part : parts) {
    const std::size_t links = part.system->links.size();
    count -= static_cast<int>(3 * links + 3 * (links - 1) + part.system->rows.size());
  }
  return count;
}

}  // namespace

bool sparse_chain_steps(Parts parts, const Couplings& between) {
  auto& shared = parts.front().work->sparse;
  if (!shared) shared = std::make_shared<SparseWorkspace>();
  SparseWorkspace& work = *shared;
  const std::vector<int> last = work.key;
  describe(parts, between, work.key);
  const bool known = work.key == last;
  if (!known) place_unknowns(parts, between, work);
  find_gradients(parts, work);
  known ? work.matrix.repeat() : work.matrix.note(work.size);
  assemble(parts, between, work);
  if (!known) {
    work.matrix.settle();
    analyse(work.matrix.lower(), work.factor);
  }
  if (!factorise(work.matrix.lower(), work.factor) || !solve(work)) return false;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    assert(parts[c].system->probe_count() == 0);
    read_step(*parts[c].system, work.chains[c], work.solution, *parts[c].step);
    parts[c].step->negative_pivots = c == 0 ? count_negative(parts, work.factor.pivots) : 0;
  }
  return true;
}

bool sparse_chain_step(const ChainSystem& system, ChainWorkspace& work, ChainStep& step) {
  const ChainPart alone{&system, &work, &step};
  return sparse_chain_steps({&alone, 1}, {});
}

bool chain_steps(Parts chains, const Couplings& couplings) {
  if (!couplings.empty()) return sparse_chain_steps(chains, couplings);
  return std::all_of(chains.begin(), chains.end(),
                     [](const ChainPart& chain) { return chain_step(*chain.system, *chain.work, *chain.step); });
}

}  // namespace wunderlich::math
