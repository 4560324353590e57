/// A step of implicit Euler under its constraints, in the metric of its own matrix.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/baseline/shell/fast_projection.hpp"

namespace wunderlich::baseline::shell {

/// [A J^T; J -e] with A = M + h^2 K on the unknowns of the three axes and J of all lengths and boundary rows at once. A
/// small e keeps rows that depend on others from breaking the solve.
struct ImplicitSystem {
  std::vector<Length> rows;  ///< those that can move at all
  /// Places among the values of the matrix, by row, of the two points' three unknowns; -1 where prescribed.
  std::vector<std::array<std::array<int, 3>, 2>> place;
  std::array<int, 4> first{};  ///< unknowns of axis a stand from first[a] on, rows from first[3]
  Sparse matrix;               ///< lower half
  std::unique_ptr<Factor> factor;
  Eigen::VectorXd right;
};

/// `implicit` are the matrices A of the axes, on their unknowns.
ImplicitSystem make_implicit_system(const Shell& shell, const Hold& hold, const std::array<Sparse, 3>& implicit);

/// Moves x by dx that minimises dx^T A dx/2 - push^T dx under the constraints linearised at x. With `push` =
/// h^2 (f - K x) + h M v that is the whole step: where it moves nothing, f - K x is balanced by the constraints,
/// whatever h. With a push of 0 it is fast projection in the metric of A. False if the solve failed.
/// @eq Goldenthal2007
bool move_implicitly(ImplicitSystem& system, const Shell& shell, const Hold& hold, const Points& push, Points& x);

/// The two halves of it: linearises at x and factors the matrix; then how the push moves the points from there, as
/// often as is wanted.
bool factor_at(ImplicitSystem& system, const Hold& hold, const Points& x);
void move_as_factored(ImplicitSystem& system, const Shell& shell, const Hold& hold, const Points& push, Points& x);

}  // namespace wunderlich::baseline::shell
