// Stage opt: projections against each other and a dense solve, the ruling bound, the flat-region rule, held frames.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "support/random_state.hpp"
#include "two_stage/cases.hpp"
#include "wunderlich/constraint/holding.hpp"
#include "wunderlich/constraint/internal.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/flat_region.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/opt.hpp"
#include "wunderlich/solver/two_stage/projection.hpp"

namespace wunderlich::testing {
namespace {

using two_stage::Projection;
using two_stage::StepReport;

/// A gently bent and twisted strip, a little off its constraints; small enough for Gauss-Seidel.
geometry::State near_feasible(const geometry::Ribbon& ribbon) {
  geometry::State shape = geometry::straight_state(ribbon);
  for (std::size_t s = 1; s < shape.q.size(); ++s) {
    const double wave = std::sin(1.3 * static_cast<double>(s));
    shape.q[s] = shape.q[s - 1] * math::exp_map({0.01 * wave, 0.15, 0.02});
    shape.eta[s] = 0.1 + 0.03 * wave;
  }
  return shape;
}

/// One Newton step of Eq. 22 by dense algebra, in the metric |dq|^2 + |d eta|^2.
geometry::State dense_step(const geometry::Ribbon& ribbon, const energy::Model& model, const geometry::State& shape) {
  const constraint::Binormal binormal{model.strain};
  const constraint::TorsionMatch match{model.strain};
  const constraint::EndRulings ends;
  const int rows =
      constraint::rows(ribbon, binormal) + constraint::rows(ribbon, match) + constraint::rows(ribbon, ends);
  const int half = constraint::rows(ribbon, binormal);
  Eigen::VectorXd residual(rows);
  geometry::Triplets triplets;
  constraint::residual(ribbon, binormal, shape, residual.segment(0, half));
  constraint::residual(ribbon, match, shape, residual.segment(half, half));
  constraint::residual(ribbon, ends, shape, residual.tail(rows - 2 * half));
  residual.tail(rows - 2 * half).setZero();  // held as they are
  constraint::add_jacobian(ribbon, binormal, shape, 0, triplets);
  constraint::add_jacobian(ribbon, match, shape, half, triplets);
  constraint::add_jacobian(ribbon, ends, shape, 2 * half, triplets);
  const Eigen::MatrixXd jacobian = dense(rows, geometry::chart_size(ribbon), triplets);
  Eigen::VectorXd inverse_metric = Eigen::VectorXd::Zero(jacobian.cols());  // r is fixed
  for (int s = 0; s < ribbon.segments; ++s) inverse_metric.segment<3>(geometry::theta_index(s)).setConstant(4);
  for (int i = 0; i < ribbon.node_count(); ++i) inverse_metric[geometry::eta_index(i)] = 1;
  const Eigen::MatrixXd normal = jacobian * inverse_metric.asDiagonal() * jacobian.transpose();
  const Eigen::VectorXd step = -inverse_metric.cwiseProduct(jacobian.transpose() * normal.fullPivLu().solve(residual));
  return moved(ribbon, shape, step);
}

double distance(const geometry::State& a, const geometry::State& b) {
  double worst = 0;
  for (std::size_t s = 0; s < a.q.size(); ++s) worst = std::max(worst, a.q[s].angularDistance(b.q[s]));
  for (std::size_t i = 0; i < a.eta.size(); ++i) worst = std::max(worst, std::abs(a.eta[i] - b.eta[i]));
  return worst;
}

/// @eq Shen2015:22
TEST(Projection22, ADirectStepIsADenseStep) {
  Case c = floating(9);
  const geometry::State start = near_feasible(c.ribbon);
  geometry::State shape = start;
  prepare(c.options, c.ribbon, c.drive, shape, c.work);
  c.options.opt.max_projections = 1;
  StepReport report;
  project(c.ribbon, c.options, shape, c.work, report);
  ASSERT_EQ(report.projections, 1);
  const geometry::State expected = dense_step(c.ribbon, c.options.model, start);
  EXPECT_GT(distance(start, expected), 1e-3);
  EXPECT_LE(distance(shape, expected), 1e-11);
}

TEST(Projection22, DirectAndGaussSeidelAgree) {
  geometry::State result[2];
  for (const Projection kind : {Projection::direct, Projection::gauss_seidel}) {
    Case c = floating(9);
    c.options.opt.projection = kind;
    c.options.opt.constraint_tolerance = 1e-9;
    c.options.opt.max_sweeps = 20000;
    geometry::State shape = near_feasible(c.ribbon);
    prepare(c.options, c.ribbon, c.drive, shape, c.work);
    StepReport report;
    EXPECT_TRUE(project(c.ribbon, c.options, shape, c.work, report));
    EXPECT_EQ(report.capped, 0);
    EXPECT_EQ(report.sweeps > 0, kind == Projection::gauss_seidel);
    result[kind == Projection::direct ? 0 : 1] = shape;
  }
  EXPECT_LE(distance(result[0], result[1]), 1e-7);
}

TEST(Projection22, GaussSeidelReportsItsCap) {
  Case c = floating(30);
  c.options.opt.projection = Projection::gauss_seidel;
  c.options.opt.max_sweeps = 5;
  geometry::State shape = near_feasible(c.ribbon);
  prepare(c.options, c.ribbon, c.drive, shape, c.work);
  StepReport report;
  project(c.ribbon, c.options, shape, c.work, report);
  EXPECT_GT(report.capped, 0);
}

TEST(Projection22, BringsRulingsBackWithinTheBound) {
  for (const Projection kind : {Projection::direct, Projection::gauss_seidel}) {
    Case c = floating(12);
    c.options.opt.projection = kind;
    geometry::State shape = near_feasible(c.ribbon);
    shape.eta[4] = 2.5;  // x = 2.4 on one side and -2.4 on the other
    shape.eta[8] = -1.5;
    prepare(c.options, c.ribbon, c.drive, shape, c.work);
    EXPECT_GT(two_stage::largest_ruling_ratio(c.ribbon, shape), 1);
    StepReport report;
    EXPECT_TRUE(project(c.ribbon, c.options, shape, c.work, report));
    EXPECT_LT(two_stage::largest_ruling_ratio(c.ribbon, shape), 1);
    EXPECT_GT(two_stage::largest_ruling_ratio(c.ribbon, shape), 0.5);
    two_stage::refresh_strains(c.ribbon, c.options.model, shape, false, c.work);
    EXPECT_LE(two_stage::constraint_residual(c.ribbon, shape, c.work), 1e-7);
  }
}

/// @eq Shen2015:21
TEST(StageOpt, NewtonAndLbfgsComeToTheSameRest) {
  double value[2];
  for (const auto kind : {two_stage::Minimiser::newton, two_stage::Minimiser::lbfgs}) {
    Case c = floating(8);
    c.options.opt.minimiser = kind;
    c.options.opt.max_iterations = 100;
    c.options.opt.gradient_change = 1e-9;
    geometry::State& shape = c.state.shape;
    for (std::size_t s = 1; s < shape.q.size(); ++s) shape.q[s] = shape.q[s - 1] * math::exp_map({0, 0.2, 0});
    for (std::size_t s = 0; s < shape.q.size(); ++s) {
      shape.r[s + 1] = shape.r[s] + shape.q[s] * Vec3(0, 0, c.ribbon.rest_length[s]);
    }
    prepare(c.options, c.ribbon, c.drive, shape, c.work);
    StepReport report;
    EXPECT_TRUE(settle_rulings(c.ribbon, c.options, c.state, c.work, report)) << report.failure;
    value[kind == two_stage::Minimiser::newton ? 0 : 1] =
        two_stage::objective_value(c.ribbon, c.options, shape, c.work);
  }
  EXPECT_GT(value[0], 0);
  EXPECT_NEAR(value[1] / value[0], 1, 1e-6);
}

/// @eq Shen2015:8
TEST(FlatRegion, MakesRulingsAsSmallAsTheBoundAllows) {
  Case c = floating(30);
  geometry::State& shape = c.state.shape;
  // Bent at both ends, flat between nodes 6 and 24.
  for (std::size_t s = 1; s < shape.q.size(); ++s) {
    const bool bent = s <= 6 || s >= 24;
    shape.q[s] = shape.q[s - 1] * (bent ? math::exp_map({0, 0.1, 0}) : Quat::Identity());
  }
  for (std::size_t i = 1; i < 30; ++i) shape.eta[i] = 0.3 * std::sin(static_cast<double>(i));
  shape.eta[6] = 1;
  shape.eta[24] = -2;
  const geometry::State before = shape;
  prepare(c.options, c.ribbon, c.drive, shape, c.work);
  two_stage::refresh_strains(c.ribbon, c.options.model, shape, false, c.work);
  EXPECT_EQ(two_stage::flatten_rulings(c.ribbon, 1e-9, shape, c.work), 17);
  const double step = 0.9 * 2 / c.ribbon.width * c.ribbon.rest_length[0];  // the rule's share of the bound
  for (std::size_t i = 0; i < 31; ++i) {
    double expected = before.eta[i];
    if (i > 6 && i < 24) {
      expected =
          std::max(0.0, 1 - step * static_cast<double>(i - 6)) - std::max(0.0, 2 - step * static_cast<double>(24 - i));
    }
    EXPECT_NEAR(shape.eta[i], expected, 1e-12) << i;
  }
}

TEST(HeldFrames, AClampHoldsTheEndsOwnFrame) {
  Case c = cantilever(12, 0.3);
  const Quat frame = c.drive.supports[0].frame;
  run(1e-3, 10, c);
  EXPECT_LE(c.state.shape.end_frame[0].angularDistance(frame), 1e-14);
  EXPECT_GT(c.state.shape.q[0].angularDistance(frame), 1e-7);
}

TEST(HeldFrames, AnOrientationConstraintLeavesTheTangentFree) {
  Case c = floating(12);
  two_stage::Support support;
  support.orientation = constraint::Orientation::about_tangent;
  support.segment = 0;
  c.drive = {{support}, {}, Vec3(0, 0, -9.81)};
  geometry::State before = c.state.shape;
  for (int k = 0; k < 60; ++k) {
    run(1e-3, 1, c);
    // d1 of the held segment turns with the tangent and by nothing else.   @eq Shen2015:18
    const Quat carried = constraint::transported(before.q[0], c.state.shape.q[0] * Vec3::UnitZ());
    EXPECT_LE(carried.angularDistance(c.state.shape.q[0]), 1e-6);
    before = c.state.shape;
  }
  EXPECT_GT(before.q[0].angularDistance(c.drive.supports[0].frame), 0.1);
  EXPECT_GT((before.q[0] * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0.05);
}

TEST(HeldFrames, APrescribedFrameIsFollowedWithinSubsteps) {
  Case c = cantilever(10, 0.1);
  c.drive.supports[0].frame = c.drive.supports[0].frame * math::exp_map({0, 0.02, 0.01});
  c.drive.supports[0].position = Vec3(0, 0, 0.0005);
  const auto report = run(2e-3, 1, c);
  EXPECT_GT(report.substeps, 1);
  EXPECT_LE(c.state.shape.end_frame[0].angularDistance(c.drive.supports[0].frame), 1e-12);
  EXPECT_LE((c.state.shape.r[0] - c.drive.supports[0].position).norm(), 1e-15);
}

TEST(HeldFrames, TheTurnOfAnOrientationConstraintIsPrescribed) {
  Case c = floating(12);
  two_stage::Support support;
  support.orientation = constraint::Orientation::about_tangent;
  support.segment = 3;
  support.node = 3;
  support.turn = 0.05;
  support.position = c.state.shape.r[3];
  c.drive.supports = {support};
  const Quat before = c.state.shape.q[3];
  run(1e-3, 4, c);
  EXPECT_NEAR(before.angularDistance(c.state.shape.q[3]), 0.2, 1e-3);
}

}  // namespace
}  // namespace wunderlich::testing
