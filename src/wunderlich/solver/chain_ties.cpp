#include "wunderlich/solver/chain_ties.hpp"

#include "wunderlich/energy/joint_energy.hpp"
#include "wunderlich/math/four.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/by_node.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::ChainLink;
using math::Four;

namespace {

/// Each column of a facet moves by theta x arm, the middle by v as well; the arms turn with the facet.
math::PoseTerm facet_term(const Ribbon& ribbon, const FacetTie& tie, const Kinematics& k, std::size_t i) {
  const Mat3 facet = facet_of(ribbon, k, i), force = (facet - tie.anchor) * tie.weight;
  Mat3 arm = facet;
  arm.col(0) -= k.r[i];
  math::PoseTerm term;
  term.node = static_cast<int>(i);
  Vec3 torque = Vec3::Zero();
  Mat3 forces = Mat3::Zero();
  for (int a = 0; a < 3; ++a) {
    torque += arm.col(a).cross(force.col(a));
    forces += arm.col(a) * force.col(a).transpose();
  }
  const Mat3 products = arm * tie.weight * arm.transpose();
  term.gradient << force.col(0), torque;
  term.hessian.topLeftCorner<3, 3>() = tie.weight(0, 0) * Mat3::Identity();
  term.hessian.topRightCorner<3, 3>() = -math::skew(arm * tie.weight.col(0));
  term.hessian.bottomLeftCorner<3, 3>() = term.hessian.topRightCorner<3, 3>().transpose();
  term.hessian.bottomRightCorner<3, 3>() = products.trace() * Mat3::Identity() - products;
  term.geometric = 0.5 * (forces + forces.transpose()) - forces.trace() * Mat3::Identity();
  return term;
}

double facet_value(const Ribbon& ribbon, const FacetTie& tie, const Kinematics& k, std::size_t i) {
  const Mat3 gap = facet_of(ribbon, k, i) - tie.anchor;
  return 0.5 * (tie.weight * gap.transpose() * gap).trace();
}

/// d2 turns with its segment. With d2 = d, its anchor a and the tie m, exactly m (a.d I - (a d^T + d a^T)/2), of which
/// m (I - d d^T) carries no force.
inline math::TurnTerm turn_term(double tie, const Vec3& anchor, const Vec3& width) {
  const Four d = math::four(width), m = math::all(tie), a = m * math::four(anchor), gradient = math::cross(a, d);
  const Four half_gap = math::all(0.5) * (m * d - a);
  const double force = 2 * math::dot3(half_gap, d);
  math::TurnTerm term;
  for (int i = 0; i < 3; ++i) {
    const Four md = math::all(tie * width[i]), di = math::all(width[i]);
    term.hessian[i] = math::last_lane(gradient[i]) - md * d;
    term.geometric[i] = di * half_gap + math::all(half_gap[i]) * d;
  }
  const Four x{1, 0, 0, 0}, y{0, 1, 0, 0}, z{0, 0, 1, 0};
  const Four f = math::all(force);
  term.hessian[0] += m * x, term.hessian[1] += m * y, term.hessian[2] += m * z;
  term.geometric[0] -= f * x, term.geometric[1] -= f * y, term.geometric[2] -= f * z;
  return term;
}

/// Of the dashpot on the hinge at node i, against its bending.
double viscosity(const Ribbon& ribbon, const ChainProblem& problem, std::size_t i) {
  return problem.viscosity * ribbon.bending_stiffness * ribbon.width * ribbon.hinge_length[i];
}

/// Bending of the hinge at node i beyond what it was before the step.
energy::Bending<double> bent(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, std::size_t i) {
  const double h = ribbon.hinge_length[i];
  const auto bending = [&](double kappa, double eta) {
    return energy::bending(problem.model.strain, h, kappa, eta, geometry::make_fold(h, kappa, eta));
  };
  energy::Bending<double> g = bending(chain.kappa[i], chain.eta[i]);
  g.value -= bending(problem.before->kappa[i], problem.before->eta[i]).value;
  return g;
}

/// Kelvin and Voigt's dashpots on the hinges.
void add_viscosity(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain,
                   std::vector<ChainLink>& links) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const energy::Bending<double> g = bent(ribbon, problem, chain, i);
    const double c = viscosity(ribbon, problem, i), f = c * g.value;
    Mat2 hessian;
    hessian << c * g.kappa * g.kappa + f * g.kappa_kappa, c * g.kappa * g.eta + f * g.kappa_eta,
        c * g.kappa * g.eta + f * g.kappa_eta, c * g.eta * g.eta + f * g.eta_eta;
    ChainLink& link = links[i > 0 ? i - 1 : 0];
    (i > 0 ? link.grad_b : link.grad_a) += f * Vec2(g.kappa, g.eta);
    (i > 0 ? link.hess_bb : link.hess_aa) += hessian;
  }
}

}  // namespace

Mat3 facet_of(const Ribbon& ribbon, const Kinematics& k, std::size_t i) {
  Mat3 facet;
  facet << k.r[i] + 0.5 * ribbon.rest_length[i] * k.frame[i].col(2), k.frame[i].col(2), k.frame[i].col(1);
  return facet;
}

double tie_value(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k) {
  double value = 0;
  for (std::size_t i = 0; i < problem.tie.size(); ++i) {
    value += 0.5 * problem.tie[i] * (k.r[i] - problem.anchor[i]).squaredNorm();
  }
  for (std::size_t i = 0; i < problem.turn_tie.size(); ++i) {
    value += 0.5 * problem.turn_tie[i] * (k.frame[i].col(1) - problem.turn_anchor[i]).squaredNorm();
  }
  for (std::size_t i = 0; i < problem.facets.size(); ++i) {
    value += facet_value(ribbon, problem.facets[i], k, i);
  }
  for (const GripTie& grip : problem.grips) {
    value += facet_value(ribbon, grip.tie, k, static_cast<std::size_t>(grip.node));
  }
  for (std::size_t i = 0; problem.viscosity > 0 && i < chain.kappa.size(); ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const double g = bent(ribbon, problem, chain, i).value;
    value += 0.5 * viscosity(ribbon, problem, i) * g * g;
  }
  return value;
}

void add_ties(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
              math::ChainSystem& system) {
  for (std::size_t i = 0; i < problem.tie.size(); ++i) {
    system.links[i].stiffness += problem.tie[i];
    system.links[i].force += math::four(problem.tie[i] * (k.r[i] - problem.anchor[i]));
  }
  system.turns.resize(problem.turn_tie.size());
  for (std::size_t i = 0; i < problem.turn_tie.size(); ++i) {
    system.turns[i] = turn_term(problem.turn_tie[i], problem.turn_anchor[i], k.frame[i].col(1));
  }
  for (std::size_t i = problem.facets.size(); i-- > 0;) {
    system.pose_terms.push_back(facet_term(ribbon, problem.facets[i], k, i));
  }
  for (const GripTie& grip : problem.grips) {
    insert_by_node(facet_term(ribbon, grip.tie, k, static_cast<std::size_t>(grip.node)), system.pose_terms);
  }
  if (problem.viscosity > 0) add_viscosity(ribbon, problem, chain, system.links);
}

}  // namespace wunderlich::solver
