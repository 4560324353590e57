#include "math/moving_chain.hpp"

#include <algorithm>

#include "wunderlich/geometry/joint.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {

using Eigen::VectorXd;
using math::ChainRow;
using math::ChainSystem;
using math::Mat6;
using math::PoseTerm;
using math::Vec6;

namespace {

struct Poses {
  std::vector<Vec3> r;
  std::vector<Quat> before, after;  ///< frames before and after each joint
};

Poses poses_of(const MovingChain& chain) {
  Poses out;
  Quat q = chain.base.frame;
  Vec3 r = chain.base.position;
  for (std::size_t i = 0; i < chain.u.size(); ++i) {
    out.before.push_back(q);
    const auto fold = geometry::make_fold(chain.hinge[i], chain.u[i][0], chain.u[i][1]);
    q = q * fold_rotation(fold, chain.u[i][1]);
    out.after.push_back(q);
    out.r.push_back(r);
    if (i < chain.span.size()) r += chain.span[i] * (q * Vec3::UnitZ());
  }
  return out;
}

/// Displacement and rotation vector of a link since the origin.
Vec6 pose_change(const MovingChain& chain, const Poses& poses, std::size_t i) {
  Vec6 out;
  out << poses.r[i] - chain.origin[i], math::log_map(poses.after[i] * chain.frame[i].conjugate());
  return out;
}

/// What a covector on (v, rotation vector) is on left increments of the frame.
Vec6 on_increments(const Vec6& change, Vec6 covector) {
  covector.tail<3>() = (math::left_jacobian_inverse(change.tail<3>()).transpose() * covector.tail<3>()).eval();
  return covector;
}

double row_value(const MovingChain& chain, const Poses& poses, const ChainRow& row) {
  const auto i = static_cast<std::size_t>(row.node);
  const Vec6 change = pose_change(chain, poses, i);
  return row.residual + row.v.dot(change.head<3>()) + row.theta.dot(change.tail<3>()) +
         row.u.dot(chain.u[i] - chain.first[i]) + row.base_v.dot(poses.r[0] - chain.base_origin) +
         row.first_u.dot(chain.u[0] - chain.first[0]);
}

/// Where a point is, from its node.
Vec3 arm(const MovingChain& chain, const Poses& poses, int node, double v) {
  const auto i = static_cast<std::size_t>(node);
  return poses.after[i] * Vec3(0, v, v * chain.u[i][1]);
}

/// What pulls at its ends.
Vec3 pull(const MovingChain& chain, const Poses& poses, const Spring& spring) {
  const Vec3 a = poses.r[static_cast<std::size_t>(spring.a)] + arm(chain, poses, spring.a, spring.va);
  const Vec3 b = poses.r[static_cast<std::size_t>(spring.b)] + arm(chain, poses, spring.b, spring.vb);
  return a - b - spring.rest;
}

void add_springs(const MovingChain& chain, const Poses& poses, ChainSystem& system) {
  for (const Spring& spring : chain.springs) {
    const Vec3 force = pull(chain, poses, spring);
    const auto point = [&](int node, double v, const Vec3& gradient) {
      const Quat& frame = poses.after[static_cast<std::size_t>(node)];
      system.points.push_back({node, arm(chain, poses, node, v), v * (frame * Vec3::UnitZ()), gradient});
      return static_cast<int>(system.points.size()) - 1;
    };
    const int a = point(spring.a, spring.va, force), b = point(spring.b, spring.vb, -force);
    const Mat3 unit = Mat3::Identity();
    system.couplings.push_back({a, a, unit, Mat3::Zero()});
    system.couplings.push_back({b, b, 0.25 * unit, 0.75 * unit});  // in two parts, of which the second carries forces
    system.couplings.push_back({a, b, -unit, Mat3::Zero()});
  }
}

Vec4 pair(const MovingChain& chain, std::size_t i) {
  Vec4 out;
  out << chain.u[i], chain.u[i + 1];
  return out;
}

}  // namespace

MovingChain random_moving_chain(int links, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.5, 1.5);
  const auto vector = [&](double scale) { return Vec3(scale * Vec3(normal(random), normal(random), normal(random))); };
  MovingChain chain;
  chain.base = {vector(1), math::exp_map(vector(1))};
  for (int i = 0; i <= links; ++i) {
    chain.hinge.push_back(0.3 * unit(random));
    if (i < links) chain.span.push_back(0.4 * unit(random));
    chain.u.emplace_back(2 * normal(random), 0.7 * normal(random));
    chain.stiffness.push_back(unit(random));
    chain.anchor.push_back(vector(1));
    const Mat4 half = Mat4::NullaryExpr([&] { return normal(random); });
    if (i < links) chain.link_gradient.push_back(Vec4::NullaryExpr([&] { return normal(random); }));
    if (i < links) chain.link_hessian.push_back(half * half.transpose() - 0.5 * Mat4::Identity());
  }
  for (const int node : {links, links, links, 2}) {
    ChainRow row;
    row.node = node;
    row.v = vector(1);
    row.theta = vector(1);
    row.u = vector(1).head<2>();
    row.base_v = vector(1);
    row.first_u = vector(1).head<2>();
    row.residual = 0.1 * normal(random);
    row.multiplier = normal(random);
    chain.rows.push_back(row);
  }
  for (const int node : {links, 1}) {
    PoseTerm term;
    term.node = node;
    term.gradient << vector(1), vector(1);
    const Mat6 half = Mat6::NullaryExpr([&] { return normal(random); });
    term.hessian = half + half.transpose();
    chain.terms.push_back(term);
  }
  const Poses poses = poses_of(chain);
  chain.origin = poses.r;
  chain.frame = poses.after;
  chain.first = chain.u;
  chain.base_origin = chain.base.position;
  return chain;
}

void add_random_springs(int count, std::mt19937& random, MovingChain& chain) {
  std::normal_distribution<double> normal;
  const int nodes = static_cast<int>(chain.u.size());
  for (int k = 0; k < count; ++k) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(nodes));
    const int b = static_cast<int>(random() % static_cast<unsigned>(nodes));
    chain.springs.push_back({a, b, normal(random), normal(random), Vec3::NullaryExpr([&] { return normal(random); })});
  }
}

MovingChain moved(const MovingChain& chain, const VectorXd& x) {
  MovingChain out = chain;
  out.base.position += x.head<3>();
  out.base.frame = math::exp_map(x.segment<3>(3)) * chain.base.frame;
  for (std::size_t i = 0; i < out.u.size(); ++i) out.u[i] += x.segment<2>(6 + 2 * static_cast<Eigen::Index>(i));
  return out;
}

double value(const MovingChain& chain) {
  const Poses poses = poses_of(chain);
  double sum = 0;
  for (std::size_t i = 0; i < poses.r.size(); ++i) {
    sum += 0.5 * chain.stiffness[i] * (poses.r[i] - chain.anchor[i]).squaredNorm();
  }
  for (std::size_t i = 0; i < chain.span.size(); ++i) {
    const Vec4 u = pair(chain, i);
    sum += chain.link_gradient[i].dot(u) + 0.5 * u.dot(chain.link_hessian[i] * u);
  }
  for (const PoseTerm& term : chain.terms) {
    const Vec6 change = pose_change(chain, poses, static_cast<std::size_t>(term.node));
    sum += term.gradient.dot(change) + 0.5 * change.dot(term.hessian * change);
  }
  for (const Spring& spring : chain.springs) sum += 0.5 * pull(chain, poses, spring).squaredNorm();
  for (const ChainRow& row : chain.rows) sum += row.multiplier * row_value(chain, poses, row);
  return sum;
}

ChainSystem system_at(const MovingChain& chain) {
  const Poses poses = poses_of(chain);
  ChainSystem system;
  system.links.resize(chain.u.size());
  for (std::size_t i = 0; i < chain.u.size(); ++i) {
    math::ChainLink& link = system.links[i];
    const double kappa = chain.u[i][0], eta = chain.u[i][1];
    const auto d = fold_derivatives(geometry::make_fold(chain.hinge[i], kappa, eta), chain.hinge[i], kappa, eta);
    const Mat3 before = poses.before[i].toRotationMatrix();
    const auto in_space = [&](const geometry::InFrame<double>& v) -> Vec3 { return before * Vec3(v.x, v.y, v.z); };
    link.axis[0] = math::four(in_space(d.kappa));
    link.axis[1] = math::four(in_space(d.eta));
    link.axis_01 = math::four(in_space(d.kappa_eta));
    link.axis_11 = math::four(in_space(d.eta_eta));
    link.stiffness = chain.stiffness[i];
    link.force = math::four(chain.stiffness[i] * (poses.r[i] - chain.anchor[i]));
    if (i == chain.span.size()) break;
    link.span = math::four(chain.span[i] * (poses.after[i] * Vec3::UnitZ()));
    const Mat4& h = chain.link_hessian[i];
    const Vec4 slope = chain.link_gradient[i] + h * pair(chain, i);
    link.grad_a = slope.head<2>();
    link.grad_b = slope.tail<2>();
    link.hess_aa = h.topLeftCorner<2, 2>();
    link.hess_ab = h.topRightCorner<2, 2>();
    link.hess_bb = h.bottomRightCorner<2, 2>();
  }
  for (ChainRow row : chain.rows) {
    const Vec6 change = pose_change(chain, poses, static_cast<std::size_t>(row.node));
    Vec6 covector;
    covector << row.v, row.theta;
    row.residual = row_value(chain, poses, row);
    row.theta = on_increments(change, covector).tail<3>();
    system.rows.push_back(row);
  }
  for (PoseTerm term : chain.terms) {
    const Vec6 change = pose_change(chain, poses, static_cast<std::size_t>(term.node));
    term.gradient = on_increments(change, term.gradient + term.hessian * change);
    system.pose_terms.push_back(term);
  }
  add_springs(chain, poses, system);
  return system;
}

VectorXd gradient(const MovingChain& chain) {
  math::ChainWorkspace work;
  math::ChainStep step;
  chain_step(system_at(chain), work, step);
  VectorXd out(6 + 2 * static_cast<Eigen::Index>(chain.u.size()));
  out.head<6>() = work.base_gradient;
  for (std::size_t i = 0; i < chain.u.size(); ++i) {
    out.segment<2>(6 + 2 * static_cast<Eigen::Index>(i)) = work.gradient[i];
  }
  return out;
}

Eigen::MatrixXd difference_hessian(const MovingChain& chain) {
  const Eigen::Index size = 6 + 2 * static_cast<Eigen::Index>(chain.u.size());
  Eigen::MatrixXd out(size, size);
  constexpr double kStep = 1e-3;
  const auto at = [&](Eigen::Index k, double h) {
    const VectorXd x = h * VectorXd::Unit(size, k);
    VectorXd g = gradient(moved(chain, x));
    g.segment<3>(3) = (math::left_jacobian(x.segment<3>(3)).transpose() * g.segment<3>(3)).eval();
    return g;
  };
  for (Eigen::Index k = 0; k < size; ++k) {
    out.col(k) = (8 * (at(k, kStep) - at(k, -kStep)) - (at(k, 2 * kStep) - at(k, -2 * kStep))) / (12 * kStep);
  }
  return out;
}

}  // namespace wunderlich::testing
