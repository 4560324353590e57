// The sparse factorisation against the sweep's oracles: dense matrices, and the exact Hessian by differences.
#include "wunderlich/math/chain_sparse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "math/dense_chain.hpp"
#include "math/moving_chain.hpp"
#include "math/random_chain.hpp"
#include "support/taylor.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using math::ChainSystem;

/// Makes chain_step take the sparse way and changes nothing else.
void couple_nothing(ChainSystem& system) {
  system.points.push_back({0, Vec3::Zero(), Vec3::Zero()});
  system.couplings.push_back({0, 0});
}

TEST(ChainSparse, SolvesWhatTheSweepSolves) {
  Random random{std::mt19937(1), {}};
  int indefinite = 0;
  for (int links : {1, 4, 8}) {
    for (const auto& base : {kHeld, kPinned, kOddlyHeld, kFloating}) {
      for (int rows : {0, 3, 6, 8}) {
        for (double softness : {0.0, 1.0}) {
          SCOPED_TRACE(std::to_string(links) + " links, " + std::to_string(rows) + " rows, softness " +
                       std::to_string(softness));
          ChainSystem system = random_system(links, base, softness, random);
          if (rows >= 2 * links + 2 + std::count(base.begin(), base.end(), false)) continue;
          add_random_rows(rows, random, system);
          const DenseStep dense = solve(dense_chain(system));
          couple_nothing(system);
          expect_same(system, dense, 1e-9);
          indefinite += dense.negative > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(indefinite, 10);
}

TEST(ChainSparse, StepIsNewtonsOnTheExactHessian) {
  std::mt19937 random(6);
  int indefinite = 0;
  for (int springs : {1, 2, 5}) {
    for (const auto& base : {kHeld, kPinned, kFloating}) {
      SCOPED_TRACE(springs);
      MovingChain chain = random_moving_chain(6, random);
      add_random_springs(springs, random, chain);
      ChainSystem system = system_at(chain);
      system.base_fixed = base;
      DenseChain dense = dense_chain(system);
      // The slope first: the dense problem knows no springs.
      const VectorXd slope = gradient(chain), d = VectorXd::NullaryExpr(slope.size(), [&] {
                                                return std::normal_distribution<double>()(random);
                                              });
      expect_derivative([&](double h) { return VectorXd::Constant(1, value(moved(chain, h * d))); },
                        VectorXd::Constant(1, slope.dot(d)));
      // Without the constraints' part, which the multipliers that are found replace.
      VectorXd held = VectorXd::Zero(dense.residual.size());
      for (std::size_t k = 0; k < system.rows.size(); ++k)
        held[static_cast<Eigen::Index>(k)] = system.rows[k].multiplier;
      dense.gradient = slope - dense.jacobian.transpose() * held;
      const MatrixXd hessian = difference_hessian(chain);
      dense.hessian = 0.5 * (hessian + hessian.transpose());
      const DenseStep step = solve(dense);
      expect_same(system, step, 1e-8);
      indefinite += step.negative > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(indefinite, 3);
}

TEST(ChainSparse, AKnownPatternIsUsedAgain) {
  std::mt19937 random(8);
  MovingChain chain = random_moving_chain(6, random);
  add_random_springs(3, random, chain);
  math::ChainWorkspace work;
  math::ChainStep first, again;
  ASSERT_TRUE(chain_step(system_at(chain), work, first));
  chain.u[2] += Vec2(0.1, 0.2);
  ChainSystem system = system_at(chain);
  ASSERT_TRUE(chain_step(system, work, again));
  math::ChainWorkspace fresh;
  math::ChainStep other;
  ASSERT_TRUE(chain_step(system, fresh, other));
  EXPECT_GT((stacked(first) - stacked(again)).norm(), 1e-3);
  EXPECT_EQ(stacked(again), stacked(other));
}

TEST(ChainSparse, ReportsWhatIsSingular) {
  Random random{std::mt19937(4), {}};
  ChainSystem system = random_system(4, kHeld, 0, random);
  couple_nothing(system);
  system.links[2].force = math::four(Vec3(0, std::nan(""), 0));
  math::ChainWorkspace work;
  math::ChainStep step;
  EXPECT_FALSE(chain_step(system, work, step));
}

}  // namespace
}  // namespace wunderlich::testing
