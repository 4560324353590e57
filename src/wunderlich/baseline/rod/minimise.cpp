#include "wunderlich/baseline/rod/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wunderlich::baseline::rod {

namespace {

constexpr double kLeastShift = 1e-4;  // over soft/length^4: what needs no more is neutral to rounding
constexpr int kMostShifts = 24, kMostHalvings = 40, kMostKicks = 30, kMostIterations = 500;

/// Factors the Hessian with a shift; returns the number of negative modes, at least 1 where it cannot be factored.
int factor_with(double shift, Workspace& work) {
  work.factors = work.system.hessian;
  for (int k = 0; k < work.factors.size; ++k) work.factors.at(k, k) += shift * work.metric[static_cast<std::size_t>(k)];
  const math::Inertia inertia = math::factor(work.factors);
  return inertia.sound ? inertia.negative : std::max(1, inertia.negative);
}

/// Factors the Hessian with the least shift tried that makes it positive; `shift` starts from that of the last time.
/// False if none does.
bool factor_shifted(const Rod& rod, Workspace& work, double& shift, Report& report) {
  const double length = rod.length, least = kLeastShift * rod.stiffness.soft / (length * length * length * length);
  double next = std::max(0.1 * shift, least);
  shift = 0;
  for (int tries = 0; tries < kMostShifts; ++tries) {
    const int negative = factor_with(shift, work);
    if (tries == 0) report.negative_modes = negative;
    if (negative == 0) return true;
    shift = next;
    next *= 10;
  }
  return false;
}

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Moves what supports move: with all else going along as the linearised rod would, or staying, whichever has less
/// energy. False if either way is barred.
bool follow_supports(const Rod& rod, bool predict, State& state, Workspace& work, Report& report) {
  const Objective& objective = work.objective;
  if (!supports_moved(work.unknowns)) return true;
  work.step.assign(static_cast<std::size_t>(work.unknowns.count), 0.0);
  expand(work.unknowns, work.step, 1, work.increment);
  if (size_of(rod, work.increment).share < 0.5) return false;
  move(rod, state, work.increment, 1, work.trial);
  const double staying = value(rod, objective, work.trial);
  double going = std::numeric_limits<double>::infinity(), shift = 0;
  if (predict) assemble(rod, objective, state, work.unknowns, work.system);
  if (predict && factor_shifted(rod, work, shift, report)) {
    for (std::size_t k = 0; k < work.step.size(); ++k) work.step[k] = -work.system.gradient[k];
    math::solve(work.factors, work.step);
    expand(work.unknowns, work.step, 1, work.increment);
    if (size_of(rod, work.increment).share == 1) {
      move(rod, state, work.increment, 1, work.other);
      going = value(rod, objective, work.other);
    }
  }
  std::fill(work.unknowns.given.begin(), work.unknowns.given.end(), 0.0);
  swap_shapes(state, going < staying ? work.other : work.trial);
  return std::isfinite(std::min(going, staying));
}

/// Takes the step if it lowers the value, or a share of it. Rounding apart, it must.
bool search(const Rod& rod, double share, double start, State& state, Workspace& work, double& now) {
  double slope = 0;
  for (std::size_t k = 0; k < work.step.size(); ++k) slope += work.step[k] * work.system.gradient[k];
  const double rounding = 1e-13 * std::abs(start);
  for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
    move(rod, state, work.increment, share, work.trial);
    now = value(rod, work.objective, work.trial);
    if (now <= start + 1e-4 * share * slope + rounding) {
      swap_shapes(state, work.trial);
      return true;
    }
    const double least = -0.5 * slope * share * share / (now - start - slope * share);  // of the parabola
    share = std::isfinite(least) ? std::clamp(least, 0.1 * share, 0.5 * share) : 0.5 * share;
  }
  return false;
}

/// Leaves a saddle along its softest mode, found by inverse iteration, to the lower side. `shift` makes the Hessian
/// positive; it is narrowed down first, for then the softest mode stands out.
bool kick(const Rod& rod, double shift, double start, State& state, Workspace& work, double& now) {
  double low = 0.01 * shift, high = shift;
  for (int pass = 0; pass < 8; ++pass) {
    const double middle = std::sqrt(low * high);
    (factor_with(middle, work) == 0 ? high : low) = middle;
  }
  factor_with(high, work);
  work.mode.resize(work.metric.size());
  for (std::size_t k = 0; k < work.mode.size(); ++k) work.mode[k] = std::sin(1.0 + 7.0 * static_cast<double>(k));
  for (int pass = 0; pass < 12; ++pass) {
    const double size = norm(work.mode);
    for (std::size_t k = 0; k < work.mode.size(); ++k) work.mode[k] *= work.metric[k] / size;
    math::solve(work.factors, work.mode);
  }
  expand(work.unknowns, work.mode, 0, work.increment);
  double amount = 1e-2 / size_of(rod, work.increment).step;
  for (int halvings = 0; halvings < 20; ++halvings, amount *= 0.5) {
    const double bound = std::min(amount, size_of(rod, work.increment).share);
    move(rod, state, work.increment, bound, work.trial);
    move(rod, state, work.increment, -bound, work.other);
    const double up = value(rod, work.objective, work.trial), down = value(rod, work.objective, work.other);
    now = std::min(up, down);
    if (now >= start) continue;
    swap_shapes(state, up < down ? work.trial : work.other);
    return true;
  }
  return false;
}

}  // namespace
const char* outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::iteration_limit:
      return "iteration limit";
    case Outcome::line_search_failed:
      return "no step lowers the energy";
    case Outcome::indefinite:
      return "no shift makes the energy's second derivative positive";
    case Outcome::saddle:
      return "at a saddle of the energy, with no way down found";
    case Outcome::stalled:
      return "no step along Newton's brings the forces nearer to balance";
    case Outcome::singular:
      return "the linearised rod has no answer to its loads";
    case Outcome::blocked:
      return "a support moves too far, or a solid is in the way";
  }
  return "";
}

Report minimise(const Rod& rod, const Options& options, State& state, Workspace& work) {
  Report report;
  State at = state;
  find_metric(rod, work.unknowns, work.metric);
  if (!follow_supports(rod, options.predict, at, work, report)) {
    report.outcome = Outcome::blocked;
    return report;
  }
  double now = value(rod, work.objective, at), shift = 0;
  if (!std::isfinite(now)) {
    report.outcome = Outcome::blocked;
    return report;
  }
  int kicks = 0;  // times it left a stationary point that was no minimum
  while (report.iterations < kMostIterations) {
    ++report.iterations;
    assemble(rod, work.objective, at, work.unknowns, work.system);
    report.outcome = Outcome::indefinite;
    if (!factor_shifted(rod, work, shift, report)) return report;
    work.step.resize(work.system.gradient.size());
    for (std::size_t k = 0; k < work.step.size(); ++k) work.step[k] = -work.system.gradient[k];
    math::solve(work.factors, work.step);
    expand(work.unknowns, work.step, 0, work.increment);
    const Size size = size_of(rod, work.increment);
    if (size.step <= kLastStep) {
      const double length = rod.length;
      const double neutral = 1.1 * kLeastShift * rod.stiffness.soft / (length * length * length * length);
      if (shift <= neutral || !options.leave_saddles) {
        move(rod, at, work.increment, 1, work.trial);
        if (std::isfinite(value(rod, work.objective, work.trial))) swap_shapes(at, work.trial);
        swap_shapes(state, at);
        report.outcome = Outcome::converged;
        return report;
      }
      report.outcome = Outcome::saddle;
      if (kicks++ == kMostKicks || !kick(rod, shift, now, at, work, now)) return report;
      continue;
    }
    if (!search(rod, size.share, now, at, work, now)) {
      report.outcome = Outcome::line_search_failed;
      return report;
    }
  }
  report.outcome = Outcome::iteration_limit;
  return report;
}

}  // namespace wunderlich::baseline::rod
