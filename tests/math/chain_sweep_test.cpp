// The sweep against dense matrices: step, multipliers, and how many modes are negative.
#include "wunderlich/math/chain_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "math/dense_chain.hpp"
#include "math/moving_chain.hpp"
#include "support/taylor.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using math::ChainRow;
using math::ChainSystem;

constexpr std::array<bool, 6> kHeld{true, true, true, true, true, true};
constexpr std::array<bool, 6> kPinned{true, true, true, false, false, false};
constexpr std::array<bool, 6> kOddlyHeld{false, true, false, false, false, true};
constexpr std::array<bool, 6> kFloating{};

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  double operator()() { return normal(engine); }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
  Vec2 pair() { return {(*this)(), (*this)()}; }
  MatrixXd symmetric(Index size, double shift) {
    const MatrixXd half = MatrixXd::NullaryExpr(size, size, [&] { return (*this)(); });
    return half * half.transpose() - shift * MatrixXd::Identity(size, size);
  }
};

/// `softness`: 0 makes every term of the Hessian positive, more makes negative modes likely.
ChainSystem random_system(int links, const std::array<bool, 6>& base_fixed, double softness, Random& random) {
  ChainSystem system;
  system.base_fixed = base_fixed;
  system.geometric = false;
  system.shift = {0.1 * std::abs(random()), 0.1 * std::abs(random())};
  for (int i = 0; i <= links; ++i) {
    math::ChainLink link;
    for (math::Four* vector : {&link.axis[0], &link.axis[1], &link.axis_01, &link.axis_11, &link.span, &link.force})
      *vector = math::four(random.vector());
    link.stiffness = std::abs(random());
    link.chart = 0.05 * random();
    link.grad_a = random.pair();
    link.grad_b = random.pair();
    const Mat4 h = random.symmetric(4, softness);
    link.hess_aa = h.topLeftCorner<2, 2>();
    link.hess_ab = h.topRightCorner<2, 2>();
    link.hess_bb = h.bottomRightCorner<2, 2>();
    system.links.push_back(link);
  }
  for (int i = 0; i < links; ++i) {
    const Vec3 force = random.vector();
    const Mat3 hessian = random.symmetric(3, softness), geometric = random.symmetric(3, softness);
    math::TurnTerm term;
    for (int a = 0; a < 3; ++a) {
      term.hessian[a] = math::four(hessian.row(a), force[a]);
      term.geometric[a] = math::four(geometric.row(a));
    }
    system.turns.push_back(term);
  }
  for (int node = links - 1; node >= 0; node -= 2) {
    math::SurfaceTerm term;
    term.node = node;
    for (Index k = 0; k < 8; ++k) term.gradient[k] = random();
    term.hessian = 0.03 * random.symmetric(8, 8 * softness);
    system.surfaces.push_back(term);
  }
  for (const int node : {links, links / 2, 0}) {
    math::PoseTerm term;
    term.node = node;
    term.gradient << random.vector(), random.vector();
    term.hessian = random.symmetric(6, softness);
    system.pose_terms.push_back(term);
  }
  return system;
}

/// Rows with a penalty see a pose only; the others see everything.
void add_random_rows(int count, Random& random, ChainSystem& system) {
  const int last = static_cast<int>(system.links.size()) - 1;
  for (int k = 0; k < count; ++k) {
    ChainRow row;
    row.node = k < 3 ? last : last - (k % (last + 1));
    row.v = random.vector();
    row.theta = random.vector();
    row.residual = random();
    row.multiplier = random();
    if (k % 2 == 0) {
      row.penalty = 10 * std::abs(random());
    } else {
      row.u = random.pair();
      row.base_v = random.vector();
      row.base_theta = random.vector();
      row.first_u = random.pair();
    }
    system.rows.push_back(row);
  }
  std::stable_sort(system.rows.begin(), system.rows.end(), [](auto& a, auto& b) { return a.node > b.node; });
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

/// The Hessian of the objective plus multipliers times rows, by differences of fourth order of the exact gradient,
/// brought into the chart at the start.
MatrixXd difference_hessian(const MovingChain& chain) {
  const Index size = 6 + 2 * static_cast<Index>(chain.u.size());
  MatrixXd out(size, size);
  constexpr double kStep = 1e-3;
  const auto at = [&](Index k, double h) {
    const VectorXd x = h * VectorXd::Unit(size, k);
    VectorXd g = gradient(moved(chain, x));
    g.segment<3>(3) = (math::left_jacobian(x.segment<3>(3)).transpose() * g.segment<3>(3)).eval();
    return g;
  };
  for (Index k = 0; k < size; ++k) {
    out.col(k) = (8 * (at(k, kStep) - at(k, -kStep)) - (at(k, 2 * kStep) - at(k, -2 * kStep))) / (12 * kStep);
  }
  return out;
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
