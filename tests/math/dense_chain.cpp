#include "math/dense_chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using math::ChainSystem;

namespace {

/// d(v_i, theta_i)/dx of every link.
std::vector<MatrixXd> pose_maps(const ChainSystem& system, Index size) {
  std::vector<MatrixXd> out;
  MatrixXd pose = MatrixXd::Zero(6, size);
  pose.leftCols<6>().setIdentity();
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    for (Index c = 0; c < 2; ++c)
      pose.block<3, 1>(3, 6 + 2 * static_cast<Index>(i) + c) += math::first_three(system.links[i].axis[c]);
    out.push_back(pose);
    if (i + 1 < system.links.size())
      pose.topRows<3>() -= math::skew(math::first_three(system.links[i].span)) * pose.bottomRows<3>();
  }
  return out;
}

void add_links(const ChainSystem& system, DenseChain& out) {
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Index k = 6 + 2 * static_cast<Index>(i);
    for (Index c = 0; c < 2; ++c) out.hessian(k + c, k + c) += system.shift[static_cast<std::size_t>(c)];
    if (i + 1 == system.links.size()) break;
    const math::ChainLink& link = system.links[i];
    out.gradient.segment<2>(k) += link.grad_a;
    out.gradient.segment<2>(k + 2) += link.grad_b;
    out.hessian.block<2, 2>(k, k) += link.hess_aa;
    out.hessian.block<2, 2>(k + 2, k + 2) += link.hess_bb;
    out.hessian.block<2, 2>(k, k + 2) += link.hess_ab;
    out.hessian.block<2, 2>(k + 2, k) += link.hess_ab.transpose();
  }
}

void add_rows(const ChainSystem& system, const std::vector<MatrixXd>& poses, DenseChain& out) {
  MatrixXd probe(static_cast<Index>(system.probe_count()), out.gradient.size());
  for (std::size_t k = 0; k < system.rows.size(); ++k) {
    const math::ChainRow& row = system.rows[k];
    math::Vec6 weight;
    weight << row.v, row.theta;
    const VectorXd seen = poses[static_cast<std::size_t>(row.node)].transpose() * weight;
    VectorXd line = seen;
    line.segment<2>(6 + 2 * row.node) += row.u;
    line.head<3>() += row.base_v;
    line.segment<3>(3) += row.base_theta;
    line.segment<2>(6) += row.first_u;
    const auto at = static_cast<Index>(k), probes = static_cast<Index>(system.probe_count());
    (at < probes ? probe.row(at) : out.jacobian.row(at - probes)) = line.transpose();
    if (at >= probes) out.residual[at - probes] = row.residual;
    out.hessian += row.penalty * seen * seen.transpose();
    out.gradient += row.penalty * row.residual * seen;
  }
  out.follower = probe.transpose() * system.follower * probe;
}

/// Curved lines in u_1 bend the Hessian by the gradient, here without what torques on joints and forces on surfaces are
/// of it.
void add_charts(const ChainSystem& system, DenseChain& out) {
  VectorXd own = VectorXd::Zero(static_cast<Index>(system.links.size()));
  for (Index i = 0; i + 1 < own.size(); ++i) {
    own[i] += system.links[static_cast<std::size_t>(i)].grad_a[1];
    own[i + 1] += system.links[static_cast<std::size_t>(i)].grad_b[1];
  }
  for (const math::ChainRow& row : system.rows) {
    own[row.node] += row.multiplier * row.u[1];
    own[0] += row.multiplier * row.first_u[1];
  }
  for (Index i = 0; i < own.size(); ++i) {
    const double bend = system.links[static_cast<std::size_t>(i)].chart * own[i];
    out.hessian(6 + 2 * i, 7 + 2 * i) -= bend;
    out.hessian(7 + 2 * i, 6 + 2 * i) -= bend;
  }
}

MatrixXd columns(const MatrixXd& matrix, const std::vector<Index>& which) {
  MatrixXd out(matrix.rows(), static_cast<Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k) out.col(static_cast<Index>(k)) = matrix.col(which[k]);
  return out;
}

}  // namespace

DenseChain dense_chain(const ChainSystem& system) {
  const Index size = 6 + 2 * static_cast<Index>(system.links.size()),
              m = static_cast<Index>(system.rows.size() - system.probe_count());
  DenseChain out{MatrixXd::Zero(size, size), {}, VectorXd::Zero(size), MatrixXd::Zero(m, size), VectorXd::Zero(m), {}};
  const std::vector<MatrixXd> poses = pose_maps(system, size);
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const MatrixXd v = poses[i].topRows<3>();
    out.hessian += system.links[i].stiffness * v.transpose() * v;
    out.gradient += v.transpose() * math::first_three(system.links[i].force);
  }
  for (const math::PoseTerm& term : system.pose_terms) {
    const MatrixXd& pose = poses[static_cast<std::size_t>(term.node)];
    out.hessian += pose.transpose() * term.hessian * pose;
    out.gradient += pose.transpose() * term.gradient;
  }
  for (std::size_t i = 0; i < system.turns.size(); ++i) {
    const MatrixXd theta = poses[i].bottomRows<3>();
    for (int a = 0; a < 3; ++a) {
      const math::TurnTerm& term = system.turns[i];
      for (int b = 0; b < 3; ++b) {
        out.hessian += (term.hessian[a][b] + (system.geometric ? term.geometric[a][b] : 0.0)) *
                       theta.row(a).transpose() * theta.row(b);
      }
      out.gradient += term.hessian[a][3] * theta.row(a).transpose();
    }
  }
  for (const math::SurfaceTerm& term : system.surfaces) {
    const auto i = static_cast<std::size_t>(term.node);
    MatrixXd map = MatrixXd::Zero(8, size);
    map.topRows<3>() =
        poses[i].topRows<3>() - math::skew(math::first_three(system.links[i].span)) * poses[i].bottomRows<3>();
    map.middleRows<3>(3) = poses[i].bottomRows<3>();
    map(6, 7 + 2 * term.node) = map(7, 9 + 2 * term.node) = 1;
    out.hessian += map.transpose() * (term.hessian + (system.geometric ? 1 : 0) * term.geometric) * map;
    out.gradient += map.transpose() * term.gradient;
  }
  add_links(system, out);
  add_rows(system, poses, out);
  if (!system.geometric) add_charts(system, out);
  for (Index k = 0; k < size; ++k) {
    if (k >= 6 || !system.base_fixed[static_cast<std::size_t>(k)]) out.free.push_back(k);
  }
  return out;
}

DenseStep solve(const DenseChain& chain) {
  const Index m = chain.residual.size(), size = static_cast<Index>(chain.free.size());
  const MatrixXd a = columns(chain.jacobian, chain.free);
  const MatrixXd h = columns(columns(chain.hessian, chain.free).transpose(), chain.free);
  const MatrixXd follower = columns(columns(chain.follower, chain.free).transpose(), chain.free).transpose();
  const VectorXd g = columns(chain.gradient.transpose(), chain.free).transpose();
  MatrixXd kkt = MatrixXd::Zero(size + m, size + m);
  kkt << h + follower, a.transpose(), a, MatrixXd::Zero(m, m);
  VectorXd right(size + m);
  right << -g, -chain.residual;
  const VectorXd solved = kkt.fullPivLu().solve(right);
  DenseStep out{VectorXd::Zero(chain.gradient.size()), solved.tail(m), 0};
  for (Index k = 0; k < size; ++k) out.x[chain.free[static_cast<std::size_t>(k)]] = solved[k];
  const MatrixXd null = m > 0 ? MatrixXd(a.fullPivLu().kernel()) : MatrixXd::Identity(size, size);
  const MatrixXd basis = MatrixXd(null.householderQr().householderQ()).leftCols(null.cols());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(basis.transpose() * h * basis, Eigen::EigenvaluesOnly);
  out.negative = static_cast<int>((eigen.eigenvalues().array() < 0).count());
  return out;
}

VectorXd stacked(const math::ChainStep& step) {
  VectorXd out(6 + 2 * static_cast<Index>(step.u.size()));
  out.head<6>() = step.base;
  for (std::size_t i = 0; i < step.u.size(); ++i) out.segment<2>(6 + 2 * static_cast<Index>(i)) = step.u[i];
  return out;
}

void expect_same(const ChainSystem& system, const DenseStep& dense, double tolerance) {
  math::ChainWorkspace work;
  math::ChainStep step;
  ASSERT_TRUE(chain_step(system, work, step));
  const VectorXd x = stacked(step);
  const VectorXd multiplier =
      Eigen::Map<const VectorXd>(step.multiplier.data() + system.probe_count(), dense.multiplier.size());
  EXPECT_GT(dense.x.norm(), 0);
  EXPECT_LE((x - dense.x).norm(), tolerance * (1 + dense.x.norm()));
  EXPECT_LE((multiplier - dense.multiplier).norm(), tolerance * (1 + dense.multiplier.norm()));
  EXPECT_EQ(step.negative_pivots, dense.negative);
}

}  // namespace wunderlich::testing
