#include "wunderlich/solver/chain_objective.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "wunderlich/energy/joint_energy.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/by_node.hpp"
#include "wunderlich/solver/chain_rows.hpp"
#include "wunderlich/solver/chain_ties.hpp"

namespace wunderlich::solver {

using constraint::LoadFrame;
using constraint::Orientation;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::ChainLink;
using math::ChainRow;
using math::ChainSystem;
using math::Four;

namespace {

double rigidity(const Ribbon& ribbon) { return ribbon.bending_stiffness * ribbon.width; }

/// Four links from `first` on: both ends of each, and what depends on the link alone. What is said of links beyond the
/// last is finite and means nothing.
struct FourLinks {
  energy::LinkEnd<Four> a, b;
  energy::LinkQuadrature<Four> rule;
  Four slope;           ///< x = slope (eta_b - eta_a), w/(2 l)
  Four x;               ///< ruling ratio
  Four weight;          ///< D w l/2
  Four barrier_weight;  ///< e1 D l/w
};

// These two fill large structures, which a compiler that does not inline them copies through memory: 8 % of a step in
// WebAssembly.
[[gnu::always_inline]] inline energy::LinkEnd<Four> link_end(const Ribbon& ribbon, const ChainProblem& problem,
                                                             const Chain& chain, const geometry::Fold<Four>& fold,
                                                             std::size_t first) {
  const Four kappa = math::load(chain.kappa, first), eta = math::load(chain.eta, first);
  const Four h = geometry::fold_lengths(ribbon, first);
  return {{kappa, eta}, energy::bending(problem.model.strain, h, kappa, eta, fold)};
}

[[gnu::always_inline]] inline FourLinks four_links(const Ribbon& ribbon, const ChainProblem& problem,
                                                   const Chain& chain, const Kinematics& k, std::size_t first) {
  const Four length = math::load(ribbon.rest_length, first);
  const auto& here = k.fold[first / 4];
  const auto& next = k.fold[std::min(first / 4 + 1, k.fold.size() - 1)];
  FourLinks links;
  links.a = link_end(ribbon, problem, chain, here, first);
  links.b = link_end(ribbon, problem, chain, geometry::moved_on(here, next), first + 1);
  links.rule = energy::four_quadratures(ribbon, problem.model, first);
  links.slope = 0.5 * ribbon.width / length;
  links.x = links.slope * (links.b.at.eta - links.a.at.eta);
  links.weight = 0.5 * rigidity(ribbon) * length;
  links.barrier_weight = problem.barrier * ribbon.bending_stiffness / ribbon.width * length;
  return links;
}

Vec3 in_space(const PointLoad& load, const Vec3& vector, const Quat& frame) {
  return load.frame == LoadFrame::space ? vector : Vec3(frame * vector);
}

/// Joints of `count` nodes from `first` on.
inline void fill_joints(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, std::size_t first,
                        std::size_t count, ChainLink* links) {
  const auto d = geometry::fold_derivatives(k.fold[first / 4], geometry::fold_lengths(ribbon, first),
                                            math::load(chain.kappa, first), math::load(chain.eta, first));
  const auto fill = [&](const Mat3& before, int lane, ChainLink& link) {
    const Four d1 = math::four(before.col(0)), d2 = math::four(before.col(1)), d3 = math::four(before.col(2));
    const auto in_space = [&](const geometry::InFrame<Four>& v) {
      return math::all(v.x[lane]) * d1 + math::all(v.y[lane]) * d2 + math::all(v.z[lane]) * d3;
    };
    link.axis[0] = in_space(d.kappa);
    link.axis[1] = in_space(d.eta);
    link.axis_01 = in_space(d.kappa_eta);
    link.axis_11 = in_space(d.eta_eta);
  };
  // Axes are given before the fold; carry them with the frame before it.
  if (first == 0) fill(chain.base.frame.toRotationMatrix(), 0, links[0]);
  for (std::size_t j = first == 0 ? 1 : 0; j < count; ++j) fill(k.frame[first + j - 1], static_cast<int>(j), links[j]);
}

void still_joint(ChainLink& link) { link.axis[0] = link.axis[1] = link.axis_01 = link.axis_11 = math::all(0); }

void fill_node(const ChainProblem& problem, std::size_t i, ChainLink& link) {
  link.chart = 0;
  link.stiffness = 0;
  link.force = math::four(-problem.force[i]);
}

/// Energy derivatives of `count` links from `first` on.
inline void fill_links(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                       std::size_t first, std::size_t count, ChainLink* links) {
  const FourLinks four = four_links(ribbon, problem, chain, k, first);
  const energy::WidthFactor<Four> wall = energy::ruling_barrier(four.x, problem.wall);
  // Nothing asks for values here, and a logarithm is dear.
  const energy::WidthFactor<Four> barrier{math::all(0), four.barrier_weight * wall.first,
                                          four.barrier_weight * wall.second};
  const energy::LinkEnergy<Four> e = energy::link_energy(energy::width_factor(problem.model, four.x), barrier,
                                                         four.slope, four.rule, four.weight, four.a, four.b);
  const auto scatter = [&](Four p, Four q, Four r, Four s, const auto& take) {
    math::transpose4(p, q, r, s);
    const Four rows[] = {p, q, r, s};
    for (std::size_t j = 0; j < count; ++j) take(links[j], rows[j]);
  };
  const auto &aa = e.hess_aa, &bb = e.hess_bb;
  const auto& ab = e.hess_ab;
  scatter(e.grad_a.kappa, e.grad_a.eta, e.grad_b.kappa, e.grad_b.eta, [](ChainLink& link, Four row) {
    link.grad_a = {row[0], row[1]};
    link.grad_b = {row[2], row[3]};
  });
  scatter(aa.kappa_kappa, aa.kappa_eta, aa.kappa_eta, aa.eta_eta,
          [](ChainLink& link, Four row) { math::store(row, link.hess_aa.data()); });
  scatter(ab.kappa_kappa, ab.eta_kappa, ab.kappa_eta, ab.eta_eta,
          [](ChainLink& link, Four row) { math::store(row, link.hess_ab.data()); });
  scatter(bb.kappa_kappa, bb.kappa_eta, bb.kappa_eta, bb.eta_eta,
          [](ChainLink& link, Four row) { math::store(row, link.hess_bb.data()); });
}

/// Coordinates that do not exist get a unit pivot and no coupling, so that the sweep leaves them alone.
void fix_coordinate(std::vector<ChainLink>& links, std::size_t i, int c) {
  ChainLink& link = links[i];
  link.axis[c] = math::all(0);
  if (c == 1) link.axis_01 = link.axis_11 = math::all(0);
  if (i + 1 < links.size()) {
    link.grad_a[c] = 0;
    link.hess_aa.row(c).setZero();
    link.hess_aa.col(c).setZero();
    link.hess_ab.row(c).setZero();
    if (i == 0) link.hess_aa(c, c) = 1;
  }
  if (i > 0) {
    ChainLink& before = links[i - 1];
    before.grad_b[c] = 0;
    before.hess_bb.row(c).setZero();
    before.hess_bb.col(c).setZero();
    before.hess_ab.col(c).setZero();
    before.hess_bb(c, c) = 1;
  }
}

/// Derivative of a load's generalized force in the pose it acts on, in the chart of left rotation increments.
/// Material: force and torque turn along; half of the torque's change is the chart's. Space: only that half.
math::Mat6 follower_stiffness(const PointLoad& load, const Quat& frame) {
  math::Mat6 k = math::Mat6::Zero();
  const Mat3 half_torque = 0.5 * math::skew(in_space(load, load.torque, frame));
  if (load.frame == LoadFrame::material) {
    k.topRightCorner<3, 3>() = math::skew(in_space(load, load.force, frame));
    k.bottomRightCorner<3, 3>() = half_torque;
  } else {
    k.bottomRightCorner<3, 3>() = -half_torque;
  }
  return k;
}

/// Point loads as gradients, with probe rows for the part of their derivative that no potential has.
void add_loads(const ChainProblem& problem, const Chain& chain, const Kinematics& k, ChainSystem& system) {
  const auto count = static_cast<Eigen::Index>(problem.loads.size());
  system.follower.setZero(6 * count, 6 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointLoad& load = problem.loads[static_cast<std::size_t>(i)];
    const Quat& frame = load.node < 0 ? chain.base.frame : k.q[static_cast<std::size_t>(load.node)];
    math::PoseTerm term;
    term.node = load.node;
    term.gradient << -in_space(load, load.force, frame), -in_space(load, load.torque, frame);
    insert_by_node(term, system.pose_terms);
    system.follower.block<6, 6>(6 * i, 6 * i) = follower_stiffness(load, frame);
    for (int c = 0; c < 6; ++c) {
      ChainRow row;
      row.node = load.node;
      (c < 3 ? row.v : row.theta) = Vec3::Unit(c % 3);
      system.rows.push_back(row);
    }
  }
}

}  // namespace

ObjectiveValue objective(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                         const Kinematics& reference) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  ObjectiveValue value;
  for (std::size_t first = 0; first < n; first += 4) {
    const FourLinks four = four_links(ribbon, problem, chain, k, first);
    const Four elastic = energy::link_bending(four.rule, four.weight, four.a, four.b) *
                         energy::width_factor(problem.model, four.x).value;
    const Four barrier = four.barrier_weight * energy::ruling_barrier(four.x, problem.wall).value;
    for (std::size_t j = 0; j < std::min<std::size_t>(4, n - first); ++j) {
      value.elastic += elastic[static_cast<int>(j)];
      value.barrier += barrier[static_cast<int>(j)];
    }
  }
  for (std::size_t i = 0; i <= n; ++i) value.loads -= problem.force[i].dot(k.r[i] - reference.r[i]);
  value.ties = tie_value(ribbon, problem, chain, k);
  for (const PointLoad& load : problem.loads) {
    const auto i = static_cast<std::size_t>(std::max(load.node, 0));
    const Quat& frame = reference.q[i];
    const Vec3 turn = math::log_map(k.q[i] * frame.conjugate());
    value.loads -= in_space(load, load.force, frame).dot(k.r[i] - reference.r[i]);
    value.loads -= in_space(load, load.torque, frame).dot(turn);
  }
  return value;
}

void linearise(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
               const std::vector<double>& multipliers, const Touching& touching, ChainSystem& system) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  system.links.resize(n + 1);
  system.base_fixed = problem.base_fixed;
  for (std::size_t first = 0; first <= n; first += 4) {
    ChainLink* const links = system.links.data() + first;
    fill_joints(ribbon, chain, k, first, std::min<std::size_t>(4, n + 1 - first), links);
    if (first < n) fill_links(ribbon, problem, chain, k, first, std::min<std::size_t>(4, n - first), links);
  }
  for (std::size_t i = 0; i <= n; ++i) {
    fill_node(problem, i, system.links[i]);
    if (i < n) system.links[i].span = math::all(ribbon.rest_length[i]) * math::four(k.frame[i].col(2));
  }
  // A loop's first joint shares its energy and turns nothing.
  if (ribbon.hinge_length[0] == 0) still_joint(system.links[0]);
  system.rows.clear();
  system.pose_terms.clear();
  system.surfaces.clear();
  system.points.clear();
  system.couplings.clear();
  add_ties(ribbon, problem, chain, k, system);
  for (const std::size_t i : {std::size_t{0}, n}) {
    if (!geometry::kappa_is_free(ribbon, static_cast<int>(i))) fix_coordinate(system.links, i, 0);
    if (!geometry::eta_is_free(ribbon, static_cast<int>(i))) fix_coordinate(system.links, i, 1);
  }
  add_loads(problem, chain, k, system);
  append_rows(ribbon, problem, chain, k, multipliers, system.rows);
  add_contact(ribbon, problem.contact, chain, k, touching.points, system);
  if (!touching.self.pairs.empty()) {
    const StripPlace place{ribbon, chain, k};
    ChainSystem* const systems[] = {&system};
    std::vector<math::ChainCoupling> none;
    add_self_contact({&place, 1}, problem.self, touching.self, systems, none);
  }
}

void use_torsion_chart(const Ribbon& ribbon, const Chain& chain, ChainSystem& system) {
  constexpr double kFlat = 0.3;  // curvature times length below which a joint counts as flat
  const double flat = kFlat / ribbon.length;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const double kappa = chain.kappa[i];
    const bool turns = geometry::eta_is_free(ribbon, static_cast<int>(i));
    system.links[i].chart = turns ? kappa / (kappa * kappa + flat * flat) : 0;
  }
}

}  // namespace wunderlich::solver
