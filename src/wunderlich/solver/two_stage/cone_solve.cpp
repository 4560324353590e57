#include "wunderlich/solver/two_stage/cone_solve.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/base/types.hpp"

namespace wunderlich::solver::two_stage {

namespace {

/// Changes one force, and all slacks with it.
void change(int row, double by, ConeProblem& problem) {
  if (by == 0) return;
  const auto size = static_cast<Eigen::Index>(problem.size);
  const double* column = problem.matrix.data() + static_cast<std::ptrdiff_t>(row) * size;
  Eigen::Map<Eigen::VectorXd>(problem.slack.data(), size) += by * Eigen::Map<const Eigen::VectorXd>(column, size);
  problem.force[static_cast<std::size_t>(row)] += by;
}

double diagonal(int row, const ConeProblem& problem) {
  return problem.matrix[static_cast<std::size_t>(row) * static_cast<std::size_t>(problem.size + 1)];
}

/// One normal row; returns how much its slack changed.
double relax_normal(int row, ConeProblem& problem) {
  const double stiffness = diagonal(row, problem);
  if (!(stiffness > 0)) return 0;
  const auto at = static_cast<std::size_t>(row);
  const double by = std::max(-problem.force[at], -problem.slack[at] / stiffness);
  change(row, by, problem);
  return std::abs(by) * stiffness;
}

/// The two tangential rows after a normal one.
double relax_tangent(int normal, ConeProblem& problem) {
  const auto a = static_cast<std::size_t>(normal + 1), b = a + 1, size = static_cast<std::size_t>(problem.size);
  const double aa = problem.matrix[a * size + a], bb = problem.matrix[b * size + b], ab = problem.matrix[a * size + b];
  const double stiffness = 0.5 * (aa + bb + std::sqrt((aa - bb) * (aa - bb) + 4 * ab * ab));  // largest eigenvalue
  if (!(stiffness > 0)) return 0;
  const auto n = static_cast<std::size_t>(normal);
  double x = problem.force[a] - problem.slack[a] / stiffness, y = problem.force[b] - problem.slack[b] / stiffness;
  put_into_disc(problem.friction[n] * problem.force[n], x, y);
  const double by_x = x - problem.force[a], by_y = y - problem.force[b];
  change(normal + 1, by_x, problem);
  change(normal + 2, by_y, problem);
  return std::hypot(by_x, by_y) * stiffness;
}

}  // namespace

void put_into_disc(double radius, double& a, double& b) {
  const double size = std::hypot(a, b);
  if (size <= radius) return;
  const double share = radius > 0 ? radius / size : 0;
  a *= share;
  b *= share;
}

ConeReport solve_cones(double tolerance, int max_sweeps, ConeProblem& problem) {
  ConeReport report;
  while (report.sweeps < max_sweeps) {
    ++report.sweeps;
    double worst = 0;
    for (int row = 0; row < problem.size; ++row) {
      const double friction = problem.friction[static_cast<std::size_t>(row)];
      if (friction < 0) continue;
      worst = std::max(worst, relax_normal(row, problem));
      if (friction > 0) worst = std::max(worst, relax_tangent(row, problem));
    }
    if (worst <= tolerance) return report;
  }
  report.capped = true;
  return report;
}

}  // namespace wunderlich::solver::two_stage
