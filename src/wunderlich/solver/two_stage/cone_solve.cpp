#include "wunderlich/solver/two_stage/cone_solve.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/base/types.hpp"

namespace wunderlich::solver::two_stage {

namespace {

constexpr int kSweepsBetween = 5;  // Newton's steps
constexpr double kShared = 1e-7;   // of the mean diagonal, in Newton's system

double norm(double a, double b) { return std::sqrt(a * a + b * b); }

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
  return norm(by_x, by_y) * stiffness;
}

/// One sweep over all rows; the largest change of a slack.
double sweep(ConeProblem& problem) {
  double worst = 0;
  for (int row = 0; row < problem.size; ++row) {
    const double friction = problem.friction[static_cast<std::size_t>(row)];
    if (friction < 0) continue;
    worst = std::max(worst, relax_normal(row, problem));
    if (friction > 0) worst = std::max(worst, relax_tangent(row, problem));
  }
  return worst;
}

/// Does the friction of a normal row hold, short of its limit?
bool holds(std::size_t row, const ConeProblem& problem) {
  const double limit = problem.friction[row] * problem.force[row];
  return norm(problem.force[row + 1], problem.force[row + 2]) < limit * (1 - 1e-9);
}

/// Gaussian elimination with row pivoting in place; false if singular.
bool solve_dense(std::size_t size, std::vector<double>& a, std::vector<double>& x) {
  using Line = Eigen::Map<Eigen::RowVectorXd>;
  const auto line = [&](std::size_t row, std::size_t from) {
    return Line(a.data() + row * size + from, static_cast<Eigen::Index>(size - from));
  };
  for (std::size_t j = 0; j < size; ++j) {
    std::size_t pivot = j;
    for (std::size_t i = j + 1; i < size; ++i) {
      if (std::abs(a[i * size + j]) > std::abs(a[pivot * size + j])) pivot = i;
    }
    if (!(std::abs(a[pivot * size + j]) > 0)) return false;
    if (pivot != j) {
      line(j, j).swap(line(pivot, j));
      std::swap(x[j], x[pivot]);
    }
    for (std::size_t i = j + 1; i < size; ++i) {
      const double share = a[i * size + j] / a[j * size + j];
      if (share == 0) continue;
      line(i, j) -= share * line(j, j);
      x[i] -= share * x[j];
    }
  }
  for (std::size_t j = size; j-- > 0;) {
    for (std::size_t k = j + 1; k < size; ++k) x[j] -= a[j * size + k] * x[k];
    x[j] /= a[j * size + j];
  }
  return true;
}

/// Newton's step: what pushes keeps w = 0, what holds too, what slides keeps its direction and its share of the push.
void solve_active(ConeProblem& problem) {
  const auto size = static_cast<std::size_t>(problem.size);
  problem.rows.clear();
  for (std::size_t row = 0; row < size; ++row) {
    if (problem.friction[row] < 0 || !(problem.force[row] > 0)) continue;
    problem.rows.push_back(static_cast<int>(row));
    if (problem.friction[row] == 0 || !holds(row, problem)) continue;
    problem.rows.push_back(static_cast<int>(row) + 1);
    problem.rows.push_back(static_cast<int>(row) + 2);
  }
  const std::size_t count = problem.rows.size();
  problem.system.resize(count * count);
  problem.rhs.resize(count);
  double trace = 0;
  for (const int row : problem.rows) trace += diagonal(row, problem);
  for (std::size_t j = 0; j < count; ++j) {
    const auto column = static_cast<std::size_t>(problem.rows[j]);
    const bool slides = problem.friction[column] > 0 && !holds(column, problem);
    const double a = slides ? problem.force[column + 1] / problem.force[column] : 0;
    const double b = slides ? problem.force[column + 2] / problem.force[column] : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = static_cast<std::size_t>(problem.rows[i]);
      double value = problem.matrix[column * size + row];
      if (slides)
        value += a * problem.matrix[(column + 1) * size + row] + b * problem.matrix[(column + 2) * size + row];
      problem.system[i * count + j] = value;
    }
    // Rows that say the same share what they hold.
    problem.system[j * count + j] += kShared * trace / static_cast<double>(count);
    problem.rhs[j] = -problem.slack[column];
  }
  if (!solve_dense(count, problem.system, problem.rhs)) return;
  for (std::size_t j = 0; j < count; ++j) {
    const int row = problem.rows[j];
    const auto at = static_cast<std::size_t>(row);
    const bool slides = problem.friction[at] > 0 && !holds(at, problem);
    const double by = problem.rhs[j], force = problem.force[at];
    if (slides) {
      change(row + 1, by * problem.force[at + 1] / force, problem);
      change(row + 2, by * problem.force[at + 2] / force, problem);
    }
    change(row, by, problem);
  }
}

/// Forces outside of what they may be are put back.
void put_back(ConeProblem& problem) {
  for (int row = 0; row < problem.size; ++row) {
    const auto at = static_cast<std::size_t>(row);
    if (problem.friction[at] < 0) continue;
    if (problem.force[at] < 0) change(row, -problem.force[at], problem);
    if (problem.friction[at] == 0) continue;
    double a = problem.force[at + 1], b = problem.force[at + 2];
    put_into_disc(problem.friction[at] * problem.force[at], a, b);
    change(row + 1, a - problem.force[at + 1], problem);
    change(row + 2, b - problem.force[at + 2], problem);
  }
}

}  // namespace

void put_into_disc(double radius, double& a, double& b) {
  const double size = norm(a, b);
  if (size <= radius) return;
  const double share = radius > 0 ? radius / size : 0;
  a *= share;
  b *= share;
}

ConeReport solve_cones(double tolerance, double enough, int max_sweeps, ConeProblem& problem) {
  ConeReport report;
  while (report.sweeps < max_sweeps) {
    double worst = 0;
    for (int i = 0; i < kSweepsBetween; ++i) {
      ++report.sweeps;
      worst = sweep(problem);
      if (worst <= tolerance) return report;
    }
    problem.force_kept = problem.force;
    problem.slack_kept = problem.slack;
    solve_active(problem);
    put_back(problem);
    ++report.sweeps;
    const double after = sweep(problem);
    if (after <= tolerance) return report;
    if (after <= worst) continue;
    problem.force = problem.force_kept;
    problem.slack = problem.slack_kept;
    if (worst <= enough) return report;
  }
  report.capped = true;
  return report;
}

}  // namespace wunderlich::solver::two_stage
