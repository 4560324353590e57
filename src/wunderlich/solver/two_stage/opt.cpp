#include "wunderlich/solver/two_stage/opt.hpp"

#include <cmath>

#include "wunderlich/solver/two_stage/flat_region.hpp"
#include "wunderlich/solver/two_stage/lbfgs_loop.hpp"
#include "wunderlich/solver/two_stage/newton.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// Why the result of stage opt cannot be accepted; nullptr if it can.
const char* fault(const Ribbon& ribbon, const Options& options, const geometry::State& shape, bool converged,
                  Workspace& work) {
  refresh_strains(ribbon, options.model, shape, false, work);
  const double violation = constraint_residual(ribbon, shape, work);
  if (!std::isfinite(violation)) return "stage opt: strains are not finite";
  if (options.opt.accept_inexact) return nullptr;
  if (violation > options.opt.constraint_tolerance) return "stage opt: constraints are not met within the tolerance";
  if (largest_ruling_ratio(ribbon, shape) >= 1) return "stage opt: rulings meet inside the strip";
  if (!converged && options.opt.minimiser == Minimiser::newton) return "stage opt: not converged";
  return nullptr;
}

}  // namespace

bool settle_rulings(const Ribbon& ribbon, const Options& options, State& state, Workspace& work, StepReport& report) {
  report.converged = false;
  bool alive = true;
  if (options.opt.minimiser == Minimiser::newton) {
    refresh_strains(ribbon, options.model, state.shape, false, work);
    report.flattened += flatten_rulings(ribbon, options.opt.flat_curvature, state.shape, work);
    alive = minimise_newton(ribbon, options, state.shape, state.multipliers, work, report);
  } else {
    alive = minimise_lbfgs(ribbon, options, state.shape, work, report);
  }
  if (!alive) return false;
  const char* reason = fault(ribbon, options, state.shape, report.converged, work);
  if (reason != nullptr) report.failure = reason;
  return reason == nullptr;
}

}  // namespace wunderlich::solver::two_stage
