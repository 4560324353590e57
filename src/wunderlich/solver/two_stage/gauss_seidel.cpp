#include "wunderlich/solver/two_stage/gauss_seidel.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::solver::two_stage {

namespace {

/// c - (J M^-1 J^T lambda) of one row.
double defect(RangeSpace& space, int row) {
  const int reach = space.normal.bandwidth, size = space.normal.size;
  double sum = space.residual[static_cast<std::size_t>(row)];
  for (int other = std::max(0, row - reach); other <= std::min(size - 1, row + reach); ++other) {
    sum -= space.normal.at(row, other) * space.multipliers[static_cast<std::size_t>(other)];
  }
  return sum;
}

}  // namespace

SweepReport solve_gauss_seidel(RangeSpace& space, double tolerance, int max_sweeps) {
  SweepReport report;
  std::fill(space.multipliers.begin(), space.multipliers.end(), 0.0);
  for (; report.sweeps < max_sweeps; ++report.sweeps) {
    double worst = 0;
    for (int row = 0; row < space.normal.size; ++row) {
      const double diagonal = space.normal.at(row, row);
      if (diagonal == 0) continue;
      double& multiplier = space.multipliers[static_cast<std::size_t>(row)];
      const double wanted = multiplier + defect(space, row) / diagonal;
      const double next = row % kBlockRows == 2 ? std::max(0.0, wanted) : wanted;
      worst = std::max(worst, std::abs(next - multiplier) * diagonal);
      multiplier = next;
    }
    if (worst <= tolerance) return report;
  }
  report.capped = true;
  return report;
}

}  // namespace wunderlich::solver::two_stage
