#include "wunderlich/solver/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/solver/newton_parts.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kKick = 0.05;  // largest fold-angle change that leaves a saddle [rad]
constexpr int kMaxHalvings = 20, kMaxKicks = 20, kMaxUnshifted = 3;
constexpr double kSaddleStep = 1e-7;  // a step this short under a shift: stationary, but is it a minimum?
constexpr int kInversePasses = 12;
constexpr double kNeutral = 1e-7, kRounding = 1e-15;  // eigenvalues below the first (units of the shift) count as zero

struct Iterate {
  const Ribbon& ribbon;
  const ChainProblem& problem;
  NewtonWorkspace& work;
  double emphasis = 1;  ///< of the rows' penalties in the merit
};

/// Solves with the smallest shift of the series that leaves no negative mode; false if none does.
bool find_direction(const Ribbon& ribbon, bool conservative, double largest, NewtonWorkspace& work,
                    NewtonReport& report, double& shift) {
  shift = shift <= kSmallestShift ? 0 : shift / kShiftFactor;
  while (shift < largest) {
    set_shift(ribbon, shift, work.system);
    ++report.sweeps;
    const bool solved = math::chain_step(work.system, work.sweep, work.step);
    if (shift == 0) report.negative_modes = work.step.negative_pivots;
    if (solved && (work.step.negative_pivots == 0 || !conservative)) return true;
    shift = shift == 0 ? 100 * kSmallestShift : kShiftFactor * shift;
  }
  return false;
}

/// Kinematics and value of the iterate, with contact.
void value_iterate(const Ribbon& ribbon, const ChainProblem& problem, const Chain& current, NewtonWorkspace& work) {
  geometry::forward_kinematics(ribbon, current, work.kinematics);
  work.value = objective(ribbon, problem, current, work.kinematics, work.kinematics);
  if (problem.touchable().empty()) return;
  find_touching(ribbon, problem.touchable(), current, work.kinematics, work.search, work.touching);
  work.value.contact = touching_energy(ribbon, problem.touchable(), work.touching);
}

/// Kinematics and value of the trial; infinite where something would be in its way.
void value_trial(const Iterate& at) {
  NewtonWorkspace& work = at.work;
  geometry::forward_kinematics(at.ribbon, work.trial, work.trial_kinematics);
  work.trial_value = objective(at.ribbon, at.problem, work.trial, work.trial_kinematics, work.kinematics);
  const Touchable touchable = at.problem.touchable();
  if (touchable.empty()) return;
  const bool free = go_touching(at.ribbon, touchable, work.touching, work.trial, work.trial_kinematics, work.search,
                                work.trial_touching);
  work.trial_value.contact =
      free ? touching_energy(at.ribbon, touchable, work.trial_touching) : std::numeric_limits<double>::infinity();
}

/// The trial becomes the iterate; loads are counted from here.
void move_on(Chain& current, NewtonWorkspace& work) {
  std::swap(current, work.trial);
  std::swap(work.kinematics, work.trial_kinematics);
  std::swap(work.touching, work.trial_touching);
  work.value = work.trial_value;
  work.value.loads = 0;
}

/// The step as far as `scale`, whatever it does to the merit; false if the result is not finite.
bool take_step(const Iterate& at, Chain& current, double scale, NewtonReport& report) {
  NewtonWorkspace& work = at.work;
  apply_step(current, work.step, scale, work.trial);
  value_trial(at);
  ++report.evaluations;
  if (!std::isfinite(work.trial_value.total())) return false;
  move_on(current, work);
  return true;
}

/// Backtracks along the step on the merit function; leaves the accepted point in the trial buffers.
bool line_search(const Iterate& at, const Chain& chain, double start, double slope, double limit,
                 NewtonReport& report) {
  NewtonWorkspace& work = at.work;
  const double rounding = 1e-13 * (std::abs(start) + std::abs(slope));
  for (double scale = limit; scale > 1e-10; scale *= 0.5) {
    apply_step(chain, work.step, scale, work.trial);
    value_trial(at);
    ++report.evaluations;
    constraint_residuals(at.ribbon, at.problem, work.trial, work.trial_kinematics, work.trial_residuals);
    const double merit = merit_of(work, work.trial_value, work.trial_residuals, at.emphasis);
    if (std::isfinite(merit) && merit <= start + 1e-4 * scale * slope + rounding) return true;
  }
  return false;
}

/// The softest direction of the reduced Hessian, left in work.step with largest entry 1: inverse iteration on the
/// shifted system from a fixed seed. False if the system is singular.
bool softest_mode(const Ribbon& ribbon, NewtonWorkspace& work) {
  const auto unit = shift_units(ribbon);
  const std::size_t count = work.system.links.size();
  unsigned seed = 1;
  const auto noise = [&] { return static_cast<double>(seed = seed * 1664525u + 1013904223u) / 4294967296.0 - 0.5; };
  for (auto& row : work.system.rows) row.residual = 0;
  work.load.resize(count);
  work.system.only_load = &work.load;
  bool found = false;
  for (int pass = 0; pass < kInversePasses; ++pass) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 u = pass == 0 ? Vec2(noise(), noise()) : work.step.u[i];
      work.load[i] = -u.cwiseProduct(unit);
      if (!geometry::kappa_is_free(ribbon, static_cast<int>(i))) work.load[i][0] = 0;
      if (!geometry::eta_is_free(ribbon, static_cast<int>(i))) work.load[i][1] = 0;
    }
    found = math::chain_step(work.system, work.sweep, work.step);
    double largest = 0;
    for (const Vec2& u : work.step.u) largest = std::max(largest, u.lpNorm<Eigen::Infinity>());
    found = found && largest > 0;
    if (!found) break;
    for (Vec2& u : work.step.u) u /= largest;
    for (Vec3& v : work.step.v) v /= largest;
    work.step.base /= largest;
  }
  work.system.only_load = nullptr;
  return found;
}

/// Moves the iterate along the direction in work.step, far enough to leave a saddle, little enough that the
/// constraints, which hold along it to first order only, are not torn.
void kick(const Iterate& at, Chain& current) {
  const Ribbon& ribbon = at.ribbon;
  NewtonWorkspace& work = at.work;
  double turn = 1e-12, fold = 0;
  for (std::size_t i = 0; i < work.step.u.size(); ++i) {
    fold = std::max(fold, std::sqrt(turn_squared(work, i)));
    turn = std::max({turn, fold, 10 * work.step.v[i].norm() / ribbon.length});
  }
  NewtonOptions small;
  small.max_turn = kKick;
  double scale = std::min(kKick / turn, step_limit(ribbon, small, current, work, fold));
  for (int i = 0; i < kMaxHalvings; ++i, scale *= 0.5) {
    apply_step(current, work.step, scale, work.trial);
    value_trial(at);
    if (!std::isfinite(work.trial_value.total())) continue;
    move_on(current, work);
    return;
  }
}

/// What a stationary iterate is: a minimum (also where the softest mode is neutral, as in sliding along a closed
/// band), a saddle, or a point that needs its last steps without a shift.
enum class Stationary { no, minimum, saddle, unshift };

/// Decided by the inertia under the smallest shift that counts as none. Overwrites work.step where it has to look.
Stationary classify(const Ribbon& ribbon, const NewtonOptions& options, double shift, double slope, double merit,
                    NewtonWorkspace& work, NewtonReport& report) {
  if (!(max_abs(work.residuals) < options.tolerance)) return Stationary::no;
  if (shift == 0 && report.last_step < options.tolerance) return Stationary::minimum;
  // At rounding level a few more full steps reach the tolerance, unless a neutral mode keeps them long.
  const bool flat = shift == 0 && -slope < kRounding * std::abs(merit) && ++report.flat > kMaxUnshifted;
  if (!(shift > 0 && report.last_step * (1 + shift) < kSaddleStep) && !flat) return Stationary::no;
  set_shift(ribbon, kNeutral, work.system);
  ++report.sweeps;
  const bool solved = math::chain_step(work.system, work.sweep, work.step);
  set_shift(ribbon, shift, work.system);
  if (!solved) return Stationary::unshift;
  if (work.step.negative_pivots > 0 && shift > 0) return Stationary::saddle;
  report.neutral = report.negative_modes > 0;
  if (!report.neutral && shift > 0 && report.unshifted++ < kMaxUnshifted) return Stationary::unshift;
  report.negative_modes = 0;
  return Stationary::minimum;
}

}  // namespace

NewtonReport minimise(const Ribbon& ribbon, const ChainProblem& problem, const NewtonOptions& options, Chain& chain,
                      std::vector<double>& multipliers, NewtonWorkspace& work) {
  NewtonReport report;
  Chain& current = work.current;
  std::vector<double>& lambda = work.multipliers;
  current = chain;
  multipliers.resize(row_count(problem), 0.0);
  lambda = multipliers;
  work.system.geometric = true;
  Iterate at{ribbon, problem, work};
  double shift = 0;
  value_iterate(ribbon, problem, current, work);
  const auto accept = [&] {
    report.outcome = NewtonOutcome::converged;
    report.value = work.value;
    chain = current;
    multipliers = lambda;
    return report;
  };
  const bool conservative = problem.loads.empty();
  while (report.iterations < options.max_iterations) {
    ++report.iterations;
    linearise(ribbon, problem, current, work.kinematics, lambda, work.touching, work.system);
    if (!find_direction(ribbon, conservative, options.largest_shift, work, report, shift)) {
      report.outcome = NewtonOutcome::singular;
      return report;
    }
    report.last_step = 0;
    const double turn = measure_step(ribbon, work, report);
    const double limit = step_limit(ribbon, options, current, work, turn);
    constraint_residuals(ribbon, problem, current, work.kinematics, work.residuals);
    report.max_residual = max_abs(work.residuals);
    if (!conservative) {
      // Nothing to descend on: full Newton steps, as far as they are bounded. A shift makes steps short that are not
      // the last ones.
      const bool small = report.last_step * (1 + shift) < options.tolerance;
      if (limit == 1 && small && report.max_residual < options.tolerance) return accept();
      if (!take_step(at, current, limit, report)) {
        report.outcome = NewtonOutcome::line_search_failed;
        return report;
      }
      lambda.assign(work.step.multiplier.begin() + static_cast<std::ptrdiff_t>(work.system.probe_count()),
                    work.step.multiplier.end());
      continue;
    }
    at.emphasis = emphasis_of(infeasibility_of(work), slope_of(work, 1));
    const double merit = merit_of(work, work.value, work.residuals, at.emphasis);
    const double slope = slope_of(work, at.emphasis);
    const Stationary kind = classify(ribbon, options, shift, slope, merit, work, report);
    if (kind == Stationary::minimum) return accept();
    if (kind == Stationary::unshift) {
      shift = 0;
      continue;
    }
    if (kind == Stationary::saddle && report.kicks < kMaxKicks) {
      ++report.kicks;
      if (softest_mode(ribbon, work)) kick(at, current);
      continue;
    }
    if (kind == Stationary::saddle || !line_search(at, current, merit, slope, limit, report)) {
      report.outcome = NewtonOutcome::line_search_failed;
      return report;
    }
    move_on(current, work);
    lambda = work.step.multiplier;
  }
  return report;
}

}  // namespace wunderlich::solver
