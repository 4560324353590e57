// Equilibria in joint coordinates against the KKT system in maximal coordinates: state, response, inertia.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "solver/paths.hpp"
#include "support/kkt.hpp"
#include "wunderlich/geometry/chart.hpp"
#include "wunderlich/solver/load_step.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using geometry::Chain;
using geometry::eta_index;
using geometry::r_index;

/// The same problem for the oracle; a loop is held at its first segment, which takes its rigid motion only.
kkt::Problem oracle_of(const PathEnd& end) {
  kkt::Problem problem;
  problem.ribbon = end.ribbon();
  problem.model = end.path.options.model;
  problem.barrier = end.path.options.barrier;
  problem.surroundings = end.path.surroundings;
  problem.time = end.path.options.duration;
  if (end.ribbon().is_loop()) {
    constraint::Support hold = clamp(0, {end.shape.r[0], end.shape.q[0]});
    hold.segment = 0;
    problem.surroundings.supports = {hold};
  }
  return problem;
}

/// The oracle's equilibrium from a start that is shaken off the sweep's, constraints and all.
kkt::Solution shaken_solution(const kkt::Problem& problem, const PathEnd& end) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  VectorXd shake = VectorXd::NullaryExpr(geometry::chart_size(problem.ribbon), [&] { return 1e-5 * normal(random); });
  geometry::State start = end.shape;
  geometry::move(problem.ribbon, shake, start);
  return kkt::solve(problem, start);
}

void expect_same_state(const geometry::Ribbon& ribbon, const geometry::State& shape, const kkt::Solution& solution) {
  const auto ours = strains(ribbon, shape), theirs = strains(ribbon, solution.state);
  double most = 0;
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    most = std::max(most, (shape.r[i] - solution.state.r[i]).norm() / ribbon.length);
    most = std::max(most, ribbon.length * std::abs(ours.kappa[i] - theirs.kappa[i]));
    most = std::max(most, std::abs(shape.eta[i] - solution.state.eta[i]));
  }
  std::cout << "  state differs by " << most << ", oracle took " << solution.iterations << " iterations\n";
  EXPECT_LE(most, 1e-8);
}

/// The sweep around a path's end, and what it answers to a force on a node.
struct Linearised {
  const PathEnd& end;
  solver::ChainProblem problem;
  Chain chain;
  std::vector<double> multipliers;
  math::ChainSystem system;
  math::ChainWorkspace work;
  math::ChainStep step;

  explicit Linearised(const PathEnd& of) : end(of), chain(of.at.chain), multipliers(of.at.multipliers) {
    solver::PathState at = end.at;
    at.phase = solver::Phase::settle;
    solver::problem_at(end.path, at, end.path.options.duration, chain, problem);
    multipliers.resize(solver::row_count(problem), 0.0);
    linearise_here();
  }

  void linearise_here() {
    geometry::Kinematics k;
    geometry::forward_kinematics(end.ribbon(), chain, k);
    linearise(end.ribbon(), problem, chain, k, multipliers, {}, system);
  }

  /// One full Newton step; returns the largest change of a fold angle. The path stops where the energy sees no
  /// difference any more, which leaves half of the digits: two such steps bring the others.
  double polish() {
    solve(system);
    double turn = 0;
    for (std::size_t i = 0; i < step.u.size(); ++i) {
      chain.kappa[i] += step.u[i][0];
      chain.eta[i] += step.u[i][1];
      turn = std::max(turn, math::first_three(math::turn_of(system.links[i], step.u[i])).norm());
    }
    multipliers = step.multiplier;
    linearise_here();
    return turn;
  }

  /// The step as (v, u) by node.
  VectorXd solve(const math::ChainSystem& of) {
    EXPECT_TRUE(chain_step(of, work, step));
    VectorXd out(5 * static_cast<Eigen::Index>(step.u.size()));
    for (std::size_t i = 0; i < step.u.size(); ++i) {
      out.segment<5>(5 * static_cast<Eigen::Index>(i)) << step.v[i], step.u[i];
    }
    return out;
  }

  /// What a further force on a node moves. A force of the objective would also stiffen the chain; as penalty times
  /// residual of a row that constrains nothing (a probe) it is a right-hand side and no more.
  VectorXd response(int node, const Vec3& force) {
    math::ChainSystem pulled = system;
    math::ChainRow row;
    row.node = node;
    row.v = force;
    row.penalty = 1e-60;
    row.residual = -1e60;
    pulled.rows.insert(pulled.rows.begin(), row);
    pulled.follower.setZero(1, 1);
    return solve(pulled) - solve(system);
  }
};

void expect_same_response(Linearised& at, const kkt::Problem& problem, const kkt::Solution& solution, int node) {
  const PathEnd& end = at.end;
  const double scale =
      end.ribbon().bending_stiffness * end.ribbon().width / (end.ribbon().length * end.ribbon().length);
  const Vec3 force = 0.1 * scale * Vec3(0.3, -0.5, 0.4);
  VectorXd right = VectorXd::Zero(geometry::chart_size(problem.ribbon));
  right.segment<3>(r_index(node)) = force;
  const kkt::Response theirs = kkt::response(problem, solution, right);
  const VectorXd ours = at.response(node, force);
  const double unit = end.ribbon().length;
  double most = 0, largest = 0;
  for (int i = 0; i <= end.ribbon().segments; ++i) {
    const Vec3 r = theirs.chart.segment<3>(r_index(i));
    const double eta = theirs.chart[eta_index(i)], kappa = theirs.kappa[static_cast<std::size_t>(i)];
    largest = std::max({largest, r.norm() / unit, std::abs(eta), unit * std::abs(kappa)});
    most = std::max({most, (ours.segment<3>(5 * i) - r).norm() / unit, std::abs(ours[5 * i + 4] - eta)});
    // A loop's curvature at node 0 is the seam's, which the chart lists at the last node.
    if (!end.ribbon().is_loop() || i > 0) most = std::max(most, unit * std::abs(ours[5 * i + 3] - kappa));
  }
  std::cout << "  response differs by " << most / largest << " of " << largest << "\n";
  EXPECT_GT(largest, 1e-3);
  EXPECT_LE(most, 1e-9 * largest);
}

void expect_agreement(const PathEnd& end, int node) {
  expect_exact(end);
  ASSERT_TRUE(end.done);
  const kkt::Problem problem = oracle_of(end);
  const kkt::Solution solution = shaken_solution(problem, end);
  ASSERT_TRUE(solution.converged) << solution.last_step;
  Linearised at(end);
  EXPECT_LE(at.polish(), 1e-8);
  EXPECT_LE(at.polish(), 1e-12);
  expect_same_state(end.ribbon(), geometry::state_of(end.ribbon(), at.chain, 0), solution);
  expect_same_response(at, problem, solution, node);
  const kkt::Inertia inertia = kkt::inertia(problem, solution);
  EXPECT_EQ(inertia.rank_loss, 0);
  EXPECT_EQ(inertia.negative, end.at.negative_modes);
  at.solve(at.system);
  EXPECT_EQ(inertia.negative, at.step.negative_pivots);
}

TEST(Oracle, TiltedCantilever) {
  const PathEnd end = cantilever(24, Vec3(0, 1.4776, -4.7767), 1e-3);
  EXPECT_GT(std::abs(end.shape.r.back().y()), 1e-3);
  expect_agreement(end, 17);
}

TEST(Oracle, ClampedClampedStrip) { expect_agreement(buckled(24, 0.8, 1e-3), 9); }

TEST(Oracle, TwistedClampedStrip) { expect_agreement(twist_clamped(36, 1e-3), 13); }

TEST(Oracle, Moebius) { expect_agreement(moebius(30, 0.4, 1e-3), 11); }

TEST(Oracle, CountsTheBucklingModesOfAHeavyColumn) {
  // An upright strip under its own weight, flat: Euler loads rho g l^3/D are 7.837 and 55.98 (Greenhill 1881).
  for (const auto& [load, negative] : std::vector<std::pair<double, int>>{{7.7, 0}, {8.0, 1}, {55.0, 1}, {57.0, 2}}) {
    SCOPED_TRACE(load);
    PathEnd end = cantilever(60, Vec3::Zero(), 1e-6);
    end.path.surroundings.gravity = Vec3(-load, 0, 0);
    const kkt::Problem problem = oracle_of(end);
    const kkt::Solution solution = kkt::solve(problem, end.shape);
    ASSERT_TRUE(solution.converged);
    EXPECT_EQ(kkt::inertia(problem, solution).negative, negative);
    Linearised at(end);
    at.solve(at.system);
    EXPECT_EQ(at.step.negative_pivots, negative);
  }
}

}  // namespace
}  // namespace wunderlich::testing
