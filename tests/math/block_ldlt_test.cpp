// Factors by dense blocks against the matrix, and against Eigen's factorisation row by row.
#include "wunderlich/math/block_ldlt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Reference = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// Links of `per_node` unknowns in a row, `springs` of which couple links far from each other; the lower triangle.
/// Every third unknown has a negative pivot of its own.
Sparse random_matrix(int nodes, int per_node, int springs, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int a, int b, double size) {
    for (int r = 0; r < per_node; ++r) {
      for (int c = 0; c < per_node; ++c) {
        const int row = a * per_node + r, column = b * per_node + c;
        if (row > column) entries.emplace_back(row, column, size * normal(random));
      }
    }
  };
  for (int i = 0; i < nodes; ++i) {
    couple(i, i, 0.3);
    if (i > 0) couple(i, i - 1, 0.3);
    for (int r = 0; r < per_node; ++r) {
      entries.emplace_back(i * per_node + r, i * per_node + r, (r % 3 == 2 ? -1 : 1) * (10 + normal(random)));
    }
  }
  std::uniform_int_distribution<int> any(0, nodes - 1);
  for (int k = 0; k < springs; ++k) {
    const int a = any(random), b = any(random);
    couple(std::max(a, b), std::min(a, b), 0.3);
  }
  Sparse lower(nodes * per_node, nodes * per_node);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

TEST(BlockLdlt, FactorsAndSolvesAsEigenDoesRowByRow) {
  std::mt19937 random(11);
  std::size_t blocks = 0, columns = 0;
  math::BlockFactor factor;  // the same for all: nothing of one pattern may stay for the next
  for (const auto& [nodes, per_node, springs] : std::vector<std::array<int, 3>>{
           {1, 1, 0}, {1, 7, 0}, {30, 1, 0}, {30, 1, 20}, {12, 5, 4}, {40, 3, 60}, {25, 14, 40}, {60, 5, 200}}) {
    SCOPED_TRACE(std::to_string(nodes) + " nodes, " + std::to_string(springs) + " springs");
    Sparse lower = random_matrix(nodes, per_node, springs, random);
    math::analyse(lower, factor);
    for (int again = 0; again < 2; ++again) {  // of the same pattern
      lower.coeffs() *= 1.25;
      Reference reference(lower);
      ASSERT_EQ(reference.info(), Eigen::Success);
      ASSERT_TRUE(math::factorise(lower, factor));
      const VectorXd pivots = reference.vectorD();
      EXPECT_LT((factor.pivots - pivots).cwiseQuotient(pivots).cwiseAbs().maxCoeff(), 1e-11);
      const VectorXd exact = VectorXd::Random(lower.cols());
      VectorXd x = lower.selfadjointView<Eigen::Lower>() * exact;
      math::solve(factor, x);
      EXPECT_LT((x - exact).norm(), 1e-11 * exact.norm());
    }
    blocks += factor.below.size();
    columns += static_cast<std::size_t>(lower.cols());
  }
  EXPECT_LT(3 * blocks, columns);  // blocks, not single columns
}

TEST(BlockLdlt, ZeroPivotsAreRefused) {
  Sparse lower(3, 3);
  lower.insert(0, 0) = 1;
  lower.insert(1, 0) = 2;
  lower.insert(1, 1) = 4;  // nothing is left of it
  lower.insert(2, 2) = 1;
  lower.insert(2, 1) = 1;
  lower.makeCompressed();
  math::BlockFactor factor;
  math::analyse(lower, factor);
  EXPECT_FALSE(math::factorise(lower, factor));
}

}  // namespace
}  // namespace wunderlich::testing
