/// L D L^T of symmetric sparse matrices by dense blocks, pivots as they come. Internal to math/.
///
/// Columns that follow each other and have the same rows below them are one block, dense from its first column on; what
/// a block does to the columns after it is a product of dense matrices.   @eq Ng1993
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace wunderlich::math {

/// Factors of one pattern, to be filled again and again.
struct BlockFactor {
  std::vector<int> first;               ///< (blocks + 1) first column of each block
  std::vector<int> block_of;            ///< (size) of each column
  std::vector<std::vector<int>> below;  ///< (blocks) rows below the block that are not zero, ascending
  std::vector<std::size_t> start;       ///< (blocks + 1) where its values start: (width + below) x width, by columns
  std::vector<double> values;  ///< unit lower triangle over what is below; the strict upper triangles mean nothing
  Eigen::VectorXd pivots;      ///< (size) the diagonal D

  std::vector<int> place;  ///< scratch: of a row in a block
  Eigen::MatrixXd scaled, update;
  Eigen::VectorXd part;
};

/// Finds blocks and rows for matrices with the pattern of `lower`, of which only the lower triangle is there, rows
/// ascending.
void analyse(const Eigen::SparseMatrix<double>& lower, BlockFactor& factor);

/// False if a pivot is 0 or not finite; there is no pivoting.
bool factorise(const Eigen::SparseMatrix<double>& lower, BlockFactor& factor);

/// Solves in place.
void solve(BlockFactor& factor, Eigen::VectorXd& x);

}  // namespace wunderlich::math
