// Banded systems against dense ones.
#include "wunderlich/math/banded.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace wunderlich::math {
namespace {

TEST(GeneralBanded, SolvesAsADenseMatrixDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int bandwidth : {1, 3, 7}) {
    const int size = 40;
    GeneralBanded banded;
    banded.reset(size, bandwidth);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i) {
      for (int j = std::max(0, i - bandwidth); j <= std::min(size - 1, i + bandwidth); ++j)
        dense(i, j) = banded.at(i, j) = i == j ? 0 : uniform(random);  // without exchanging rows the first pivot is 0
    }
    const Eigen::VectorXd right = Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
    std::vector<double> x(right.data(), right.data() + size);
    ASSERT_TRUE(factor(banded));
    solve(banded, x);
    const Eigen::Map<Eigen::VectorXd> found(x.data(), size);
    EXPECT_LE((dense * found - right).norm(), 1e-11 * dense.norm() * found.norm());
    EXPECT_GE(found.norm(), 0.1);
  }
}

TEST(GeneralBanded, SaysWhereAMatrixIsSingular) {
  GeneralBanded banded;
  banded.reset(4, 1);
  for (int i = 0; i < 4; ++i) banded.at(i, i) = i == 2 ? 0 : 1;
  EXPECT_FALSE(factor(banded));
}

}  // namespace
}  // namespace wunderlich::math
