/// Fast projection: points are moved to where their constraints hold, by the least motion in the metric of their
/// masses.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "wunderlich/baseline/shell/hold.hpp"

namespace wunderlich::baseline::shell {

/// Two rows that share an unknown, and where their product stands.
struct RowProduct {
  int value = 0;  ///< index among the values of the matrix
  int row = 0, other = 0;
  Vec3 weight = Vec3::Zero();  ///< sign over the mass of the shared unknown, by axis [1/kg]
};

using Factor = Eigen::SimplicialLDLT<Sparse>;

/// One set of lengths with what its solves need again and again.
struct LengthSystem {
  std::vector<Length> rows;  ///< those that can move at all
  std::vector<RowProduct> products;
  Sparse matrix;  ///< J M^-1 J^T, its lower half
  std::unique_ptr<Factor> factor;
  Points direction;  ///< gradient of each row by its second point
  Eigen::VectorXd residual;
};

LengthSystem make_length_system(const std::vector<Length>& set, const Hold& hold);

/// Linear rows (`Shell::boundary`), factored once an axis.
struct BoundarySystem {
  std::array<Sparse, 3> to_unknowns;  ///< M^-1 J^T on the unknowns of each axis
  std::array<std::unique_ptr<Factor>, 3> factor;
};

BoundarySystem make_boundary_system(const Sparse& boundary, const Hold& hold);

/// Residuals C = (|d|^2/L - L)/2 and their gradients at x.   @eq Goldenthal2007
void linearise(LengthSystem& system, const Points& x);

/// Largest | |d|/L - 1 |.
double max_length_error(const std::vector<Length>& rows, const Points& x);

/// One iteration: dx = -M^-1 J^T lambda with (J M^-1 J^T) lambda = C. (The h^2 of the paper stands in lambda.) A share
/// of 1e-10 on the diagonal keeps rows that depend on others from breaking the solve.   @eq Goldenthal2007 False if the
/// solve failed.
bool project_lengths(LengthSystem& system, const Hold& hold, Points& x);

/// Moves x to where `boundary` x = 0: one solve, for they are linear. False if it failed.
bool project_boundary(const BoundarySystem& system, const Sparse& boundary, const Hold& hold, Points& x);

}  // namespace wunderlich::baseline::shell
