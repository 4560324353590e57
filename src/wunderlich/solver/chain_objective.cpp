#include "wunderlich/solver/chain_objective.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "wunderlich/energy/joint_energy.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using constraint::LoadFrame;
using constraint::Orientation;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::ChainLink;
using math::ChainRow;
using math::ChainSystem;

namespace {

double rigidity(const Ribbon& ribbon) { return ribbon.bending_stiffness * ribbon.width; }

/// e1 D l_s/w of one segment.
double barrier_weight(const Ribbon& ribbon, const ChainProblem& problem, std::size_t segment) {
  return problem.barrier * ribbon.bending_stiffness * ribbon.rest_length[segment] / ribbon.width;
}

/// A node as an end of a link; the weight depends on the link.
energy::LinkEnd link_end(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                         std::size_t node) {
  const double h = geometry::fold_length(ribbon, node), kappa = chain.kappa[node], eta = chain.eta[node];
  return {kappa, eta, energy::bending(problem.model.strain, h, kappa, eta, k.fold[node]), 0};
}

/// Half the link belongs to each end's hinge, nothing where there is none.
double end_weight(const Ribbon& ribbon, std::size_t link, std::size_t node) {
  return geometry::fold_length(ribbon, node) > 0 ? 0.5 * rigidity(ribbon) * ribbon.rest_length[link] : 0.0;
}

/// Turn of the frame `q` about its tangent against `reference` transported along the shortest rotation of the
/// tangent, and the row that is its gradient.                                            @eq Shen2015:18
struct TangentTurn {
  double angle = 0;
  Vec3 gradient = Vec3::Zero();
};

TangentTurn tangent_turn(const Quat& q, const Quat& reference) {
  const Vec3 t0 = reference * Vec3::UnitZ(), t1 = q * Vec3::UnitZ();
  const Quat carried = math::shortest_rotation(t0, t1) * reference;
  const Vec3 turn = math::log_map(q * carried.conjugate());
  return {turn.dot(t1), (t0 + t1) / (1 + t0.dot(t1))};
}

/// Calls `emit(v, theta, residual)` for each row of a hold.
template <class Emit>
void for_each_row(const Hold& hold, const Chain& chain, const Kinematics& k, const Emit& emit) {
  const auto i = static_cast<std::size_t>(hold.node);
  const Vec3 gap = k.r[i] - hold.target.position;
  for (int c = 0; c < 3; ++c) {
    if (hold.position[static_cast<std::size_t>(c)]) emit(Vec3::Unit(c), Vec3::Zero(), gap[c]);
  }
  if (hold.orientation == Orientation::full) {
    // The step's total rotation is exactly minus this vector, so the row is linear.
    const Vec3 turn = math::log_map(k.q[i] * hold.target.frame.conjugate());
    for (int c = 0; c < 3; ++c) emit(Vec3::Zero(), Vec3::Unit(c), turn[c]);
  } else if (hold.orientation == Orientation::about_tangent) {
    const TangentTurn turn = tangent_turn(hold.on_base ? chain.base.frame : k.q[i], hold.target.frame);
    emit(Vec3::Zero(), turn.gradient, turn.angle);
  }
}

/// The last frame is the first one seen across the seam, and so are kappa and eta.
struct Closure {
  Vec3 gap;
  Vec3 turn;
  Vec2 u;
};

Closure closure(const Ribbon& ribbon, const Chain& chain, const Kinematics& k) {
  const Quat ghost = geometry::across_seam(ribbon, k.q.front());
  return {k.r.back() - k.r.front(), math::log_map(k.q.back() * ghost.conjugate()),
          Vec2(chain.kappa.back() - ribbon.seam_sign() * chain.kappa.front(),
               chain.eta.back() - ribbon.seam_sign() * chain.eta.front())};
}

Vec3 in_space(const PointLoad& load, const Vec3& vector, const Quat& frame) {
  return load.frame == LoadFrame::space ? vector : Vec3(frame * vector);
}

/// Stiffness of the penalty that makes pivots a valid second-order test: far above the strip's own
/// D w / l^3 (positions) and D w / l (rotations).
struct Penalty {
  double position, rotation;
};

Penalty penalties(const Ribbon& ribbon) {
  const double position = 1e4 * rigidity(ribbon) / (ribbon.length * ribbon.length * ribbon.length);
  return {position, position * ribbon.length * ribbon.length / 40};
}

void append_rows(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                 const std::vector<double>& multipliers, std::vector<ChainRow>& rows) {
  const Penalty penalty = penalties(ribbon);
  const std::size_t probes = rows.size();
  const auto push = [&](ChainRow row) {
    row.multiplier = multipliers[rows.size() - probes];
    rows.push_back(row);
  };
  if (problem.closed) {
    const Closure gap = closure(ribbon, chain, k);
    // With a floating base the penalty would couple it to the last node; the recursion has no room for that.
    const bool floating = !problem.base_fixed[0] || !problem.base_fixed[3];
    for (int c = 0; c < 8; ++c) {
      ChainRow row;
      row.node = ribbon.segments;
      if (c < 3) {
        row.v = Vec3::Unit(c);
        row.base_v = -row.v;
        row.residual = gap.gap[c];
        row.penalty = floating ? 0 : penalty.position;
      } else if (c < 6) {
        row.theta = Vec3::Unit(c - 3);
        row.base_theta = -row.theta;
        row.residual = gap.turn[c - 3];
        row.penalty = floating ? 0 : penalty.rotation;
      } else {
        row.u = Vec2::Unit(c - 6);
        row.first_u = -ribbon.seam_sign() * row.u;
        row.residual = gap.u[c - 6];
      }
      push(row);
    }
  }
  for (const Hold& hold : problem.holds) {
    for_each_row(hold, chain, k, [&](const Vec3& v, const Vec3& theta, double residual) {
      ChainRow row;
      row.node = hold.node;
      row.v = v;
      row.residual = residual;
      (hold.on_base ? row.base_theta : row.theta) = theta;
      // Rows on the base need none: its pivots are those of a small matrix, counted exactly.
      if (!v.isZero())
        row.penalty = penalty.position;
      else if (!hold.on_base)
        row.penalty = penalty.rotation;
      push(row);
    });
  }
}

void fill_joint(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, std::size_t i, ChainLink& link) {
  const double h = ribbon.hinge_length[i];
  if (h == 0) {
    link.axes.setZero();
    link.axes_01.setZero();
    link.axes_11.setZero();
    return;
  }
  // Axes are given before the fold; carry them with the frame before it: q_{i-1} = q_i fold^-1.
  const geometry::FoldDerivatives d = geometry::fold_derivatives(k.fold[i], h, chain.kappa[i], chain.eta[i]);
  const Mat3 base = i > 0 ? Mat3() : Mat3(chain.base.frame.toRotationMatrix());
  const Mat3& before = i > 0 ? k.frame[i - 1] : base;
  const math::Four d1 = math::four(before.col(0)), d2 = math::four(before.col(1)), d3 = math::four(before.col(2));
  const auto in_space = [&](const Vec3& v) -> Vec3 {
    return math::first_three(math::all(v[0]) * d1 + math::all(v[1]) * d2 + math::all(v[2]) * d3);
  };
  link.axes.col(0) = in_space(d.kappa);
  link.axes.col(1) = in_space(d.eta);
  link.axes_01 = in_space(d.kappa_eta);
  link.axes_11 = in_space(d.eta_eta);
}

void fill_node(const ChainProblem& problem, const Kinematics& k, std::size_t i, ChainLink& link) {
  link.stiffness = problem.tie.empty() ? 0 : problem.tie[i];
  link.force = -problem.force[i];
  if (!problem.tie.empty()) link.force += link.stiffness * (k.r[i] - problem.anchor[i]);
}

void fill_link(const Ribbon& ribbon, const ChainProblem& problem, std::size_t i, const energy::LinkEnd& a,
               const energy::LinkEnd& b, ChainLink& link) {
  const double slope = 0.5 * ribbon.width / ribbon.rest_length[i], x = slope * (b.eta - a.eta);
  const double e1 = barrier_weight(ribbon, problem, i);
  energy::WidthFactor barrier = energy::ruling_barrier(x);
  barrier.value *= e1;
  barrier.first *= e1;
  barrier.second *= e1;
  const energy::LinkEnergy e = energy::link_energy(energy::width_factor(problem.model, x), barrier, slope,
                                                   energy::quadrature(ribbon, problem.model, i), a, b);
  link.grad_a = e.grad_a;
  link.grad_b = e.grad_b;
  link.hess_aa = e.hess_aa;
  link.hess_ab = e.hess_ab;
  link.hess_bb = e.hess_bb;
}

/// Bending of the hinge at node i beyond what it was before the step.
energy::Bending bent(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                     std::size_t i) {
  const double h = ribbon.hinge_length[i], kappa = problem.before->kappa[i], eta = problem.before->eta[i];
  energy::Bending g = energy::bending(problem.model.strain, h, chain.kappa[i], chain.eta[i], k.fold[i]);
  g.value -= energy::bending(problem.model.strain, h, kappa, eta, geometry::make_fold(h, kappa, eta)).value;
  return g;
}

/// Kelvin and Voigt's dashpots on the hinges.
void add_viscosity(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                   std::vector<ChainLink>& links) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const energy::Bending g = bent(ribbon, problem, chain, k, i);
    const double c = problem.viscosity * rigidity(ribbon) * ribbon.hinge_length[i], f = c * g.value;
    Mat2 hessian;
    hessian << c * g.kappa * g.kappa + f * g.kappa_kappa, c * g.kappa * g.eta + f * g.kappa_eta,
        c * g.kappa * g.eta + f * g.kappa_eta, c * g.eta * g.eta + f * g.eta_eta;
    ChainLink& link = links[i > 0 ? i - 1 : 0];
    (i > 0 ? link.grad_b : link.grad_a) += f * Vec2(g.kappa, g.eta);
    (i > 0 ? link.hess_bb : link.hess_aa) += hessian;
  }
}

/// Coordinates that do not exist get a unit pivot and no coupling, so that the sweep leaves them alone.
void fix_coordinate(std::vector<ChainLink>& links, std::size_t i, int c) {
  ChainLink& link = links[i];
  link.axes.col(c).setZero();
  if (c == 1) {
    link.axes_01.setZero();
    link.axes_11.setZero();
  }
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

/// Middle, d3 and d2 of segment i as columns.
Mat3 facet_of(const Ribbon& ribbon, const Kinematics& k, std::size_t i) {
  Mat3 facet;
  facet << k.r[i] + 0.5 * ribbon.rest_length[i] * k.frame[i].col(2), k.frame[i].col(2), k.frame[i].col(1);
  return facet;
}

/// Each column of a facet moves by theta x arm, the middle by v as well; the arms turn with the facet.
math::PoseTerm facet_term(const Ribbon& ribbon, const FacetTie& tie, const Kinematics& k, std::size_t i) {
  const Mat3 facet = facet_of(ribbon, k, i), force = (facet - tie.anchor) * tie.weight;
  Mat3 arm = facet;
  arm.col(0) -= k.r[i];
  math::PoseTerm term;
  term.node = static_cast<int>(i);
  Vec3 torque = Vec3::Zero();
  Mat3 products = Mat3::Zero(), forces = Mat3::Zero();
  for (int a = 0; a < 3; ++a) {
    torque += arm.col(a).cross(force.col(a));
    forces += arm.col(a) * force.col(a).transpose();
  }
  products = arm * tie.weight * arm.transpose();
  term.gradient << force.col(0), torque;
  term.hessian.topLeftCorner<3, 3>() = tie.weight(0, 0) * Mat3::Identity();
  term.hessian.topRightCorner<3, 3>() = -math::skew(arm * tie.weight.col(0));
  term.hessian.bottomLeftCorner<3, 3>() = term.hessian.topRightCorner<3, 3>().transpose();
  term.hessian.bottomRightCorner<3, 3>() = products.trace() * Mat3::Identity() - products;
  term.geometric = 0.5 * (forces + forces.transpose()) - forces.trace() * Mat3::Identity();
  return term;
}

/// Keeps the terms sorted by decreasing node.
void insert(const math::PoseTerm& term, std::vector<math::PoseTerm>& terms) {
  const auto after = std::upper_bound(terms.begin(), terms.end(), term,
                                      [](const auto& a, const auto& b) { return a.node > b.node; });
  terms.insert(after, term);
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
    insert(term, system.pose_terms);
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

std::size_t row_count(const Hold& hold) {
  std::size_t count = 0;
  for (const bool held : hold.position) count += held ? 1 : 0;
  if (hold.orientation == Orientation::full) count += 3;
  if (hold.orientation == Orientation::about_tangent) count += 1;
  return count;
}

std::size_t row_count(const ChainProblem& problem) {
  std::size_t count = problem.closed ? 8 : 0;
  for (const Hold& hold : problem.holds) count += row_count(hold);
  return count;
}

ObjectiveValue objective(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                         const Kinematics& reference) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  ObjectiveValue value;
  energy::LinkEnd b = link_end(ribbon, problem, chain, k, 0);
  for (std::size_t s = 0; s < n; ++s) {
    energy::LinkEnd a = b;
    b = link_end(ribbon, problem, chain, k, s + 1);
    a.weight = end_weight(ribbon, s, s);
    b.weight = end_weight(ribbon, s, s + 1);
    const double x = 0.5 * ribbon.width * (b.eta - a.eta) / ribbon.rest_length[s];
    value.elastic += energy::link_bending(energy::quadrature(ribbon, problem.model, s), a, b) *
                     energy::width_factor(problem.model, x).value;
    value.barrier += barrier_weight(ribbon, problem, s) * energy::ruling_barrier(x).value;
  }
  for (std::size_t i = 0; i <= n; ++i) value.rest -= problem.force[i].dot(k.r[i] - reference.r[i]);
  for (std::size_t i = 0; i < problem.tie.size(); ++i) {
    value.rest += 0.5 * problem.tie[i] * (k.r[i] - problem.anchor[i]).squaredNorm();
  }
  for (std::size_t i = 0; i < problem.facets.size(); ++i) {
    const FacetTie& tie = problem.facets[i];
    const Mat3 gap = facet_of(ribbon, k, i) - tie.anchor;
    value.rest += 0.5 * (tie.weight * gap.transpose() * gap).trace();
  }
  for (std::size_t i = 0; problem.viscosity > 0 && i <= n; ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const double g = bent(ribbon, problem, chain, k, i).value;
    value.rest += 0.5 * problem.viscosity * rigidity(ribbon) * ribbon.hinge_length[i] * g * g;
  }
  for (const PointLoad& load : problem.loads) {
    const auto i = static_cast<std::size_t>(std::max(load.node, 0));
    const Quat& frame = reference.q[i];
    const Vec3 turn = math::log_map(k.q[i] * frame.conjugate());
    value.rest -= in_space(load, load.force, frame).dot(k.r[i] - reference.r[i]);
    value.rest -= in_space(load, load.torque, frame).dot(turn);
  }
  return value;
}

void constraint_residuals(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                          std::vector<double>& residuals) {
  residuals.clear();
  if (problem.closed) {
    const Closure gap = closure(ribbon, chain, k);
    residuals.insert(residuals.end(), gap.gap.begin(), gap.gap.end());
    residuals.insert(residuals.end(), gap.turn.begin(), gap.turn.end());
    residuals.insert(residuals.end(), gap.u.begin(), gap.u.end());
  }
  for (const Hold& hold : problem.holds) {
    for_each_row(hold, chain, k, [&](const Vec3&, const Vec3&, double residual) { residuals.push_back(residual); });
  }
}

void linearise(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
               const std::vector<double>& multipliers, ChainSystem& system) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  system.links.resize(n + 1);
  system.base_fixed = problem.base_fixed;
  energy::LinkEnd b = link_end(ribbon, problem, chain, k, 0);
  for (std::size_t i = 0; i <= n; ++i) {
    ChainLink& link = system.links[i];
    fill_joint(ribbon, chain, k, i, link);
    fill_node(problem, k, i, link);
    if (i == n) break;
    energy::LinkEnd a = b;
    b = link_end(ribbon, problem, chain, k, i + 1);
    a.weight = end_weight(ribbon, i, i);
    b.weight = end_weight(ribbon, i, i + 1);
    fill_link(ribbon, problem, i, a, b, link);
    link.span = ribbon.rest_length[i] * k.frame[i].col(2);
  }
  if (problem.viscosity > 0) add_viscosity(ribbon, problem, chain, k, system.links);
  for (const std::size_t i : {std::size_t{0}, n}) {
    if (!geometry::kappa_is_free(ribbon, static_cast<int>(i))) fix_coordinate(system.links, i, 0);
    if (!geometry::eta_is_free(ribbon, static_cast<int>(i))) fix_coordinate(system.links, i, 1);
  }
  system.rows.clear();
  system.pose_terms.clear();
  for (std::size_t i = problem.facets.size(); i-- > 0;) {
    system.pose_terms.push_back(facet_term(ribbon, problem.facets[i], k, i));
  }
  add_loads(problem, chain, k, system);
  append_rows(ribbon, problem, chain, k, multipliers, system.rows);
}

}  // namespace wunderlich::solver
