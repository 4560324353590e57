// The sweep against dense matrices: step, multipliers, and how many modes are negative.
#include "wunderlich/math/chain_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "math/dense_chain.hpp"
#include "math/moving_chain.hpp"
#include "math/random_chain.hpp"
#include "support/taylor.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using math::ChainRow;
using math::ChainSystem;

TEST(ChainSweep, SolvesTheDenseSystem) {
  Random random{std::mt19937(1), {}};
  int indefinite = 0;
  for (int links : {1, 4, 5, 8}) {
    for (const auto& base : {kHeld, kPinned, kOddlyHeld, kFloating}) {
      for (int rows : {0, 1, 3, 6, 8}) {
        for (double softness : {0.0, 1.0}) {
          SCOPED_TRACE(std::to_string(links) + " links, " + std::to_string(rows) + " rows, softness " +
                       std::to_string(softness));
          ChainSystem system = random_system(links, base, softness, random);
          const auto free = 2 * links + 2 + std::count(base.begin(), base.end(), false);
          if (rows >= free) continue;
          add_random_rows(rows, random, system);
          const DenseStep dense = solve(dense_chain(system));
          expect_same(system, dense, 1e-10);
          indefinite += dense.negative > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(indefinite, 20);
}

TEST(ChainSweep, ManyRows) {
  // More than fit on the stack.
  Random random{std::mt19937(2), {}};
  ChainSystem system = random_system(12, kFloating, 0.5, random);
  add_random_rows(20, random, system);
  expect_same(system, solve(dense_chain(system)), 1e-10);
}

TEST(ChainSweep, LoadsWithoutAPotential) {
  Random random{std::mt19937(7), {}};
  for (int rows : {0, 6}) {
    for (const auto& base : {kHeld, kFloating}) {
      ChainSystem system = random_system(5, base, 0, random);
      std::vector<ChainRow> probes(6);
      for (int k = 0; k < 6; ++k) {
        auto& probe = probes[static_cast<std::size_t>(k)];
        probe.node = k < 3 ? 5 : 2;
        probe.v = random.vector();
        probe.theta = random.vector();
      }
      add_random_rows(rows, random, system);
      system.rows.insert(system.rows.begin(), probes.begin(), probes.end());
      system.follower = MatrixXd::NullaryExpr(6, 6, [&] { return random(); });
      const DenseChain dense = dense_chain(system);
      EXPECT_GT((dense.follower - dense.follower.transpose()).norm(), 0.1);
      expect_same(system, solve(dense), 1e-10);
    }
  }
}

TEST(ChainSweep, NodeDisplacementsFollowTheStep) {
  Random random{std::mt19937(3), {}};
  const ChainSystem system = random_system(6, kFloating, 0, random);
  math::ChainWorkspace work;
  math::ChainStep step;
  ASSERT_TRUE(chain_step(system, work, step));
  math::Vec6 pose = step.base;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    EXPECT_LE((step.v[i] - pose.head<3>()).norm(), 1e-13 * (1 + pose.norm()));
    pose.tail<3>() += math::first_three(math::turn_of(system.links[i], step.u[i]));
    pose.head<3>() += pose.tail<3>().cross(math::first_three(system.links[i].span));
  }
}

TEST(ChainSweep, ReportsWhatIsSingular) {
  Random random{std::mt19937(4), {}};
  ChainSystem system = random_system(4, kHeld, 0, random);
  add_random_rows(3, random, system);
  math::ChainWorkspace work;
  math::ChainStep step;
  ASSERT_TRUE(chain_step(system, work, step));
  ChainSystem flat = system;
  flat.shift = {0, 0};
  for (auto& link : flat.links) {
    link.axis[1] = math::all(0);
    link.chart = 0;
    for (Mat2* block : {&link.hess_aa, &link.hess_ab, &link.hess_bb}) {
      block->row(1).setZero();
      block->col(1).setZero();
    }
  }
  flat.rows.clear();
  flat.surfaces.clear();
  EXPECT_FALSE(chain_step(flat, work, step));  // nothing depends on the second coordinate
  system.links[2].force = math::four(Vec3(0, std::nan(""), 0));
  EXPECT_FALSE(chain_step(system, work, step));
}

TEST(ChainSweepSecondOrder, GradientIsTheSlopeOfTheObjective) {
  std::mt19937 random(5);
  for (int links : {2, 5, 8}) {
    SCOPED_TRACE(links);
    const MovingChain chain = random_moving_chain(links, random);
    std::normal_distribution<double> normal;
    const VectorXd d = VectorXd::NullaryExpr(6 + 2 * (links + 1), [&] { return normal(random); });
    expect_derivative([&](double h) { return VectorXd::Constant(1, value(moved(chain, h * d))); },
                      VectorXd::Constant(1, gradient(chain).dot(d)));
  }
}

TEST(ChainSweepSecondOrder, StepIsNewtonsOnTheExactHessian) {
  std::mt19937 random(6);
  int indefinite = 0;
  for (int links : {4, 6, 8}) {
    for (const auto& base : {kHeld, kPinned, kFloating}) {
      SCOPED_TRACE(links);
      const MovingChain chain = random_moving_chain(links, random);
      ChainSystem system = system_at(chain);
      system.base_fixed = base;
      DenseChain dense = dense_chain(system);
      const MatrixXd hessian = difference_hessian(chain);
      EXPECT_LE((hessian - hessian.transpose()).norm(), 1e-9 * hessian.norm());
      EXPECT_GT((hessian - dense.hessian).norm(), 1e-2 * hessian.norm());  // forces matter
      dense.hessian = 0.5 * (hessian + hessian.transpose());
      const DenseStep step = solve(dense);
      expect_same(system, step, 1e-8);
      indefinite += step.negative > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(indefinite, 3);
}

}  // namespace
}  // namespace wunderlich::testing
