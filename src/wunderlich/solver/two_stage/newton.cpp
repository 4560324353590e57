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

/// Factors the exact system with the least shift in use; failing that, ones made positive.
bool factor_positive(const Ribbon& ribbon, const Options& options, const geometry::State& shape,
                     const std::vector<double>& multipliers, double shift, Workspace& work, StepReport& report) {
  assemble_kkt(ribbon, options, shape, multipliers, Curvature::exact, shift, work);
  if (factor_kkt(ribbon, work)) return true;
  for (const double more : {0.0, 1e-2, 1.0, 1e2, 1e4}) {
    ++report.shifts;
    assemble_kkt(ribbon, options, shape, multipliers, Curvature::safe, std::max(shift, more), work);
    if (factor_kkt(ribbon, work)) return true;
  }
  return false;
}

/// The shift of the next iteration: more where the model promised too much, less as it proves right.
double next_shift(double shift, bool cut) { return cut ? std::max(4 * shift, 0.05) : (shift > 0.01 ? shift / 4 : 0); }

/// What a line search asks: the merit f + mu |c|_1 at its start, and how fast the step lowers it.
struct Merit {
  double weight;  ///< mu
  double value;
  double slope;
};

/// Is the shape moved by `share` of work.step low enough; strains and residuals become its own.
bool goes_down(const Ribbon& ribbon, const Options& options, const Merit& merit, double share, geometry::State& shape,
               Workspace& work) {
  const double rounding = 1e-13 * (std::abs(merit.value) + work.parallel_weight);
  move_unknowns(ribbon, work.step, share, work, shape);
  refresh_strains(ribbon, options.model, shape, false, work);
  constraint_residual(ribbon, shape, work);
  const double trial = objective_value(ribbon, options, shape, work) + merit.weight * l1(work.residual);
  return std::isfinite(trial) && trial <= merit.value + 1e-4 * share * merit.slope + rounding;
}

/// Backtracks on the merit. Where the longest step fails, what its constraints gained at second order is taken back
/// once: kappa eta makes full steps look bad that are good. Returns the share taken, 0 if none goes down.
double line_search(const Ribbon& ribbon, const Options& options, const Merit& merit, double longest,
                   geometry::State& shape, Workspace& work, StepReport& report) {
  if (goes_down(ribbon, options, merit, longest, shape, work)) return longest;
  solve_correction(ribbon, work);
  for (std::size_t i = 0; i < work.step.size(); ++i) work.step[i] += work.correction[i] / longest;
  if (goes_down(ribbon, options, merit, longest, shape, work)) return longest;
  for (std::size_t i = 0; i < work.step.size(); ++i) work.step[i] -= work.correction[i] / longest;
  double share = 0.5 * longest;
  for (int attempt = 0; attempt < 25; ++attempt, share *= 0.5) {
    ++report.cuts;
    if (goes_down(ribbon, options, merit, share, shape, work)) return share;
  }
  move_unknowns(ribbon, work.step, 0, work, shape);
  return 0;
}

/// Largest turn of a frame [rad] and, as it decides less, a hundredth of the largest change of eta.
double size_of(const std::vector<double>& step) {
  double worst = 0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const double size = std::abs(step[i]) * (i % 4 == 0 ? 0.01 : 1);
    if (!(size <= worst)) worst = size;  // keeps a NaN
  }
  return worst;
}

}  // namespace

bool minimise_newton(const Ribbon& ribbon, const Options& options, geometry::State& shape,
                     std::vector<double>& multipliers, Workspace& work, StepReport& report) {
  double shift = 0;
  for (int iteration = 0; iteration < options.opt.max_iterations; ++iteration) {
    refresh_strains(ribbon, options.model, shape, true, work);
    const double violation = constraint_residual(ribbon, shape, work);
    objective_gradient(ribbon, options, shape, work);
    if (!factor_positive(ribbon, options, shape, multipliers, shift, work, report)) {
      report.failure = "stage opt: no shift made the Hessian positive";
      return false;
    }
    solve_kkt(ribbon, work, multipliers);
    ++report.iterations;
    const double size = size_of(work.step);
    if (!std::isfinite(size) || !std::isfinite(violation)) {
      report.failure = "stage opt: the step is not finite";
      return false;
    }
    work.q_start = shape.q;
    work.eta_start = shape.eta;
    Merit merit{0, 0, 0};
    for (double m : multipliers) merit.weight = std::max(merit.weight, 2 * std::abs(m));
    merit.value = objective_value(ribbon, options, shape, work) + merit.weight * l1(work.residual);
    merit.slope = -merit.weight * l1(work.residual);
    for (std::size_t i = 0; i < work.step.size(); ++i) merit.slope += work.gradient[i] * work.step[i];
    const double longest = longest_step(ribbon, shape, work);
    report.cuts += longest < 1;
    const double share = line_search(ribbon, options, merit, longest, shape, work, report);
    if (share == 0) return true;  // not converged
    shift = next_shift(shift, share < longest);
    if (share == 1 && size <= options.opt.step_tolerance) {
      report.converged = true;
      return true;
    }
  }
  return true;
}

}  // namespace wunderlich::solver::two_stage
