#include "wunderlich/solver/two_stage/newton.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/solver/two_stage/kkt.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

double l1(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += std::abs(v);
  return sum;
}

/// Factors the exact system; failing that, ones made positive.
bool factor_positive(const Ribbon& ribbon, const Options& options, const geometry::State& shape,
                     const std::vector<double>& multipliers, Workspace& work, StepReport& report) {
  assemble_kkt(ribbon, options, shape, multipliers, Curvature::exact, 0, work);
  if (factor_kkt(ribbon, work)) return true;
  for (const double shift : {0.0, 1e-2, 1.0, 1e2, 1e4}) {
    ++report.shifts;
    assemble_kkt(ribbon, options, shape, multipliers, Curvature::safe, shift, work);
    if (factor_kkt(ribbon, work)) return true;
  }
  return false;
}

/// Backtracks on f + mu |c|_1. Returns the share taken, 0 if none goes down; strains are those of the new shape.
double line_search(const Ribbon& ribbon, const Options& options, double weight, double slope, double merit,
                   double share, geometry::State& shape, Workspace& work, StepReport& report) {
  const double rounding = 1e-13 * (std::abs(merit) + work.parallel_weight);
  for (int attempt = 0; attempt < 25; ++attempt, share *= 0.5) {
    move_unknowns(ribbon, work.step, share, work, shape);
    refresh_strains(ribbon, options.model, shape, false, work);
    constraint_residual(ribbon, shape, work);
    const double trial = objective_value(ribbon, options, shape, work) + weight * l1(work.residual);
    if (std::isfinite(trial) && trial <= merit + 1e-4 * share * slope + rounding) return share;
    ++report.cuts;
  }
  move_unknowns(ribbon, work.step, 0, work, shape);
  return 0;
}

double largest_turn(const std::vector<double>& step) {
  double worst = 0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const double size = std::abs(step[i]);
    if (!(size <= worst)) worst = size;  // keeps a NaN
  }
  return worst;
}

}  // namespace

bool minimise_newton(const Ribbon& ribbon, const Options& options, geometry::State& shape,
                     std::vector<double>& multipliers, Workspace& work, StepReport& report) {
  for (int iteration = 0; iteration < options.opt.max_iterations; ++iteration) {
    refresh_strains(ribbon, options.model, shape, true, work);
    const double violation = constraint_residual(ribbon, shape, work);
    objective_gradient(ribbon, options, shape, work);
    if (!factor_positive(ribbon, options, shape, multipliers, work, report)) {
      report.failure = "stage opt: no shift made the Hessian positive";
      return false;
    }
    solve_kkt(ribbon, work, multipliers);
    ++report.iterations;
    const double size = largest_turn(work.step);
    if (!std::isfinite(size) || !std::isfinite(violation)) {
      report.failure = "stage opt: the step is not finite";
      return false;
    }
    work.q_start = shape.q;
    work.eta_start = shape.eta;
    double weight = 0;
    for (double m : multipliers) weight = std::max(weight, 2 * std::abs(m));
    double slope = -weight * l1(work.residual);
    for (std::size_t i = 0; i < work.step.size(); ++i) slope += work.gradient[i] * work.step[i];
    const double merit = objective_value(ribbon, options, shape, work) + weight * l1(work.residual);
    const double longest = longest_step(ribbon, shape, work);
    report.cuts += longest < 1;
    const double share = line_search(ribbon, options, weight, slope, merit, longest, shape, work, report);
    if (share == 0) return true;  // not converged; the caller looks at the constraints
    if (share == 1 && size <= options.opt.step_tolerance) {
      report.converged = true;
      return true;
    }
  }
  return true;
}

}  // namespace wunderlich::solver::two_stage
