#include "wunderlich/solver/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

/// How far |x| may move towards 1 in one step, as a share of the way.
constexpr double kBoundaryFraction = 0.9;
constexpr double kKick = 0.05;  // largest fold-angle change that leaves a saddle [rad]
constexpr int kMaxHalvings = 20, kMaxKicks = 20, kMaxUnshifted = 3;
constexpr double kSaddleStep = 1e-7;  // a step this short under a shift: stationary, but is it a minimum?
constexpr int kInversePasses = 12;
constexpr double kNeutral = 1e-7, kRounding = 1e-15;  // eigenvalues below the first (units of the shift) count as zero
constexpr double kHeld = 1e-13;     // of the rows (m, rad, 1) at the end of a step in time; lengths beyond 1 m count
constexpr int kUnsettled = 3;       // first iterations, in which what sticks and what slips sorts itself ...
constexpr double kSettling = 3e-4;  // ... unless steps are shorter than this
constexpr double kSmallestShift = 1e-9, kLargestShift = 1e6, kShiftFactor = 5;

struct Iterate {
  const Ribbon& ribbon;
  const ChainProblem& problem;
  NewtonWorkspace& work;
  double emphasis = 1;  ///< of the rows' penalties in the merit
  double merit(const ObjectiveValue& value, const std::vector<double>& residuals) const;
  double slope() const;
  void weigh_rows();
};

/// Objective + new multipliers * rows + emphasis penalty/2 * rows^2: the Newton step is a descent direction of it.
double Iterate::merit(const ObjectiveValue& value, const std::vector<double>& residuals) const {
  double merit = value.total();
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    merit += residuals[i] * (work.step.multiplier[i] + 0.5 * emphasis * work.system.rows[i].penalty * residuals[i]);
  }
  return merit;
}

double Iterate::slope() const {
  double slope = work.sweep.base_gradient.dot(work.step.base);
  for (std::size_t i = 0; i < work.step.u.size(); ++i) slope += work.sweep.gradient[i].dot(work.step.u[i]);
  for (std::size_t i = 0; i < work.system.rows.size(); ++i) {
    const auto& row = work.system.rows[i];
    slope -= row.residual * (work.step.multiplier[i] - row.multiplier + emphasis * row.penalty * row.residual);
  }
  return slope;
}

/// As much penalty as makes the step a descent: the Hessian on the constraints is positive, but under strong reactions
/// the one with the system's penalties need not be. At least half of what the rows lose must show. @eq Nocedal2006:18.5
void Iterate::weigh_rows() {
  emphasis = 1;
  double infeasibility = 0;
  for (const auto& row : work.system.rows) infeasibility += row.penalty * row.residual * row.residual;
  const double excess = slope() + 0.5 * infeasibility;
  if (infeasibility > 0 && excess > 0) emphasis += excess / infeasibility;
}

/// Square of the angle by which the step turns the joint at a node.
double turn_squared(const NewtonWorkspace& work, std::size_t node) {
  const math::Four turn = math::turn_of(work.system.links[node], work.step.u[node]);
  return math::dot3(turn, turn);
}

/// Largest fold-angle change, displacement / length, and (scaled: it is soft where kappa vanishes) eta change; all go
/// into the report. Returns the largest fold-angle change alone.
double measure_step(const Ribbon& ribbon, const NewtonWorkspace& work, NewtonReport& report) {
  const double shorter = 1 / (ribbon.length * ribbon.length);
  double most = 0, turn = 0;
  for (std::size_t i = 0; i < work.step.u.size(); ++i) {
    const double turned = turn_squared(work, i), moved = work.step.v[i].squaredNorm() * shorter;
    const double slanted = 1e-6 * work.step.u[i][1] * work.step.u[i][1];
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double size = turned + moved + slanted < kInfinity ? std::max({turned, moved, slanted}) : kInfinity;
    turn = std::max(turn, turned);
    if (size <= most) continue;
    most = size;
    report.worst_node = static_cast<int>(i);
  }
  report.last_step = std::sqrt(most);
  return std::sqrt(turn);
}

/// Shortens the step to keep |x| < 1 and fold angles from jumping.
double step_limit(const Ribbon& ribbon, const NewtonOptions& options, const Chain& chain, const NewtonWorkspace& work,
                  double largest_turn) {
  double limit = 1;
  const auto& step = work.step;
  for (std::size_t s = 0; s + 1 < step.u.size(); ++s) {
    const double k = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = k * (chain.eta[s + 1] - chain.eta[s]);
    const double dx = k * (step.u[s + 1][1] - step.u[s][1]);
    const double room = kBoundaryFraction * (dx > 0 ? 1 - x : 1 + x);
    if (limit * std::abs(dx) > room) limit = room / std::abs(dx);
  }
  const double turn = std::max(step.base.tail<3>().norm(), largest_turn);
  return turn * limit > options.max_turn ? options.max_turn / turn : limit;
}

void apply_step(const Chain& chain, const math::ChainStep& step, double scale, Chain& trial) {
  trial.base.position = chain.base.position + scale * step.base.head<3>();
  trial.base.frame = (math::exp_map(scale * step.base.tail<3>()) * chain.base.frame).normalized();
  trial.kappa.resize(step.u.size());
  trial.eta.resize(step.u.size());
  for (std::size_t i = 0; i < step.u.size(); ++i) {
    trial.kappa[i] = chain.kappa[i] + scale * step.u[i][0];
    trial.eta[i] = chain.eta[i] + scale * step.u[i][1];
  }
}

/// NaN if any value is: it must not pass for small.
double max_abs(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) {
    if (std::isnan(v)) return v;
    most = std::max(most, std::abs(v));
  }
  return most;
}

/// What a shift of 1 means: the bending energy of a segment in kappa, and D l/w in eta.
Vec2 shift_units(const Ribbon& ribbon) {
  const double l = ribbon.length / ribbon.segments;
  return ribbon.bending_stiffness * l * Vec2(ribbon.width, 1 / ribbon.width);
}

/// The base too: a strip that hangs on one pin may turn about the vertical freely.
void set_shift(const Ribbon& ribbon, double shift, math::ChainSystem& system) {
  const Vec2 unit = shift * shift_units(ribbon);
  const double base = shift * ribbon.bending_stiffness * ribbon.width / ribbon.length;
  system.shift = {unit[0], unit[1]};
  system.base_shift = {base / (ribbon.length * ribbon.length), base};
}

/// Solves without a shift, if need be without the terms that carry forces. False if negative modes are left.
bool find_inertial_direction(const Ribbon& ribbon, NewtonWorkspace& work, NewtonReport& report) {
  set_shift(ribbon, 0, work.system);
  for (const bool geometric : {true, false}) {
    work.system.geometric = geometric;
    ++report.sweeps;
    if (math::chain_step(work.system, work.sweep, work.step) && work.step.negative_pivots == 0) return true;
  }
  return false;
}

/// Solves with the smallest shift of the series that leaves no negative mode; false if none does.
bool find_direction(const Ribbon& ribbon, bool conservative, NewtonWorkspace& work, NewtonReport& report,
                    double& shift) {
  shift = shift <= kSmallestShift ? 0 : shift / kShiftFactor;
  while (shift < kLargestShift) {
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
  const bool placed = work.placed;
  work.placed = false;
  if (!placed) geometry::forward_kinematics(ribbon, current, work.kinematics);
  work.value = objective(ribbon, problem, current, work.kinematics, work.kinematics);
  if (problem.touchable().empty()) return;
  if (!placed) find_touching(ribbon, problem.touchable(), current, work.kinematics, work.search, work.touching);
  work.value.contact = touching_energy(ribbon, problem.touchable(), work.touching);
  work.value.friction = friction_value(problem.contact, work.kinematics);
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
  work.trial_value.friction = friction_value(touchable.contact, work.trial_kinematics);
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

/// Do the rows hold to rounding, after the last step? They are not linear in it.
bool rows_hold(const Iterate& at, const Chain& current, NewtonReport& report) {
  constraint_residuals(at.ribbon, at.problem, current, at.work.kinematics, at.work.residuals);
  report.max_residual = max_abs(at.work.residuals);
  return report.max_residual <= kHeld * std::max(1.0, at.ribbon.length);
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
    const double merit = at.merit(work.trial_value, work.trial_residuals);
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

/// Has friction been looked at closely, and does its exact Hessian do better than a majorant?
bool is_settled(const NewtonReport& report) {
  return report.iterations > kUnsettled || (report.iterations > 1 && report.last_step < kSettling);
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
  int polished = 0;
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
    work.touching.points.settled = !options.inertial || problem.contact.friction.empty() || is_settled(report);
    linearise(ribbon, problem, current, work.kinematics, lambda, work.touching, work.system);
    if (options.inertial && conservative) use_torsion_chart(ribbon, current, work.system);
    if (options.inertial && find_inertial_direction(ribbon, work, report)) {
      shift = 0;
    } else if (!find_direction(ribbon, conservative, work, report, shift)) {
      report.outcome = NewtonOutcome::singular;
      return report;
    }
    const double turn = measure_step(ribbon, work, report);
    const double limit = step_limit(ribbon, options, current, work, turn);
    constraint_residuals(ribbon, problem, current, work.kinematics, work.residuals);
    report.max_residual = max_abs(work.residuals);
    // A shift makes steps short that are not the last ones.
    const bool small = limit == 1 && report.last_step * (1 + shift) < options.tolerance &&
                       report.max_residual < options.tolerance && work.touching.points.settled;
    if (!conservative || (options.inertial && small)) {
      // Nothing to descend on, or nothing left to gain: full Newton steps, as far as they are bounded.
      if (small && !options.inertial) return accept();
      if (!take_step(at, current, limit, report)) {
        report.outcome = NewtonOutcome::line_search_failed;
        return report;
      }
      lambda.assign(work.step.multiplier.begin() + static_cast<std::ptrdiff_t>(work.system.probe_count()),
                    work.step.multiplier.end());
      // One step more where the rows ask for it: what they were held to would add up over the steps in time.
      if (small && (rows_hold(at, current, report) || ++polished > 1)) return accept();
      continue;
    }
    at.weigh_rows();
    const double merit = at.merit(work.value, work.residuals);
    const double slope = at.slope();
    const Stationary kind =
        options.inertial ? Stationary::no : classify(ribbon, options, shift, slope, merit, work, report);
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
