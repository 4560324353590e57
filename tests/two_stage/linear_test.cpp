// The linear algebra that the two-stage method brings: banded LDL^T and L-BFGS.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "wunderlich/math/banded.hpp"
#include "wunderlich/math/lbfgs.hpp"

namespace wunderlich {
namespace {

TEST(Banded, SolvesAsADenseSolveDoes) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const int size = 40, bandwidth = 6;
  math::BandedMatrix banded;
  banded.reset(size, bandwidth);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = std::max(0, i - bandwidth); j <= i; ++j) {
      // Every third pivot negative, and large enough to need no pivoting.
      const double value = i == j ? (i % 3 == 0 ? -20 : 20) : normal(random);
      banded.at(j, i) += value;
      dense(i, j) = dense(j, i) = value;
    }
  }
  std::vector<double> x(size);
  for (double& v : x) v = normal(random);
  const Eigen::VectorXd right = Eigen::Map<Eigen::VectorXd>(x.data(), size);
  const math::Inertia inertia = math::factor(banded);
  math::solve(banded, x);
  EXPECT_TRUE(inertia.sound);
  EXPECT_EQ(inertia.negative, 14);
  EXPECT_EQ(inertia.positive, 26);
  const Eigen::VectorXd expected = dense.fullPivLu().solve(right);
  EXPECT_LE((Eigen::Map<Eigen::VectorXd>(x.data(), size) - expected).norm(), 1e-13 * expected.norm());
}

TEST(Banded, SaysWhenAPivotVanishes) {
  math::BandedMatrix matrix;
  matrix.reset(2, 1);
  matrix.at(0, 0) = matrix.at(1, 1) = matrix.at(1, 0) = 1;  // singular
  EXPECT_FALSE(math::factor(matrix).sound);
}

TEST(Banded, FoldingKeepsRingNeighboursClose) {
  for (const int count : {5, 6, 51}) {
    std::vector<int> seen(static_cast<std::size_t>(count), 0);
    for (int i = 0; i < count; ++i) {
      ++seen[static_cast<std::size_t>(math::folded_place(i, count))];
      for (int d : {1, 2}) {
        EXPECT_LE(std::abs(math::folded_place(i, count) - math::folded_place((i + d) % count, count)), 2 * d);
      }
    }
    for (int times : seen) EXPECT_EQ(times, 1);
  }
}

TEST(Lbfgs, FindsTheMinimumOfAQuadratic) {
  const std::vector<double> stiffness{1, 3, 10, 30, 100};
  std::vector<double> x{1, -1, 1, -1, 1}, gradient(5), direction, step(5), change(5);
  math::Lbfgs memory;
  memory.reset(5);
  const auto slope = [&] {
    for (std::size_t i = 0; i < 5; ++i) gradient[i] = stiffness[i] * x[i];
  };
  slope();
  for (int iteration = 0; iteration < 40; ++iteration) {
    memory.direction(gradient, 0.01, direction);
    double down = 0, curvature = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      down -= direction[i] * gradient[i];
      curvature += stiffness[i] * direction[i] * direction[i];
    }
    ASSERT_GT(down, 0);
    for (std::size_t i = 0; i < 5; ++i) {
      step[i] = down / curvature * direction[i];
      x[i] += step[i];
      change[i] = stiffness[i] * step[i];
    }
    slope();
    if (down < 1e-24) break;
    memory.push(step, change);
  }
  for (double value : x) EXPECT_NEAR(value, 0, 1e-10);
}

TEST(Lbfgs, IgnoresPairsOfNegativeCurvature) {
  math::Lbfgs memory;
  memory.reset(2);
  memory.push({1, 0}, {-1, 0});
  EXPECT_EQ(memory.stored, 0);
}

}  // namespace
}  // namespace wunderlich
