/// The paper's partial projected Gauss-Seidel on the multipliers of Eq. 22.
#pragma once

#include "wunderlich/solver/two_stage/range_space.hpp"

namespace wunderlich::solver::two_stage {

/// Sweeps taken, and whether they were cut off at their limit.
struct SweepReport {
  int sweeps = 0;
  bool capped = false;
};

/// Sweeps over J M^-1 J^T lambda = c, projecting lambda >= 0 for the ruling bound alone, until no row is off by more
/// than `tolerance` or the cap is reached. The matrix is a discrete Laplacian: sweeps grow as n^2.   @eq Shen2015:22
SweepReport solve_gauss_seidel(RangeSpace& space, double tolerance, int max_sweeps);

}  // namespace wunderlich::solver::two_stage
