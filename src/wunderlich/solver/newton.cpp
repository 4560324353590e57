#include "wunderlich/solver/newton.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

/// How far |x| may move towards 1 in one step, as a share of the way.
constexpr double kBoundaryFraction = 0.9;
constexpr double kKick = 0.05;   // largest fold-angle change that leaves a saddle [rad]
constexpr double kSaddleStep = 1e-7;
constexpr double kSmallestShift = 1e-9, kLargestShift = 1e6, kShiftFactor = 5;

struct Iterate {
  const Ribbon& ribbon;
  const ChainProblem& problem;
  NewtonWorkspace& work;
  double merit_of(const Chain& chain, const Kinematics& k, std::vector<double>& residuals) const;
  double slope() const;
};

/// Objective + new multipliers * rows + penalty/2 * rows^2: the Newton step is a descent direction of it.
double Iterate::merit_of(const Chain& chain, const Kinematics& k, std::vector<double>& residuals) const {
  constraint_residuals(ribbon, problem, chain, k, residuals);
  double merit = objective(ribbon, problem, chain, k, work.kinematics).total();
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    merit += residuals[i] * (work.step.multiplier[i] + 0.5 * work.system.rows[i].penalty * residuals[i]);
  }
  return merit;
}

double Iterate::slope() const {
  double slope = work.sweep.base_gradient.dot(work.step.base);
  for (std::size_t i = 0; i < work.step.u.size(); ++i) slope += work.sweep.gradient[i].dot(work.step.u[i]);
  for (std::size_t i = 0; i < work.system.rows.size(); ++i) {
    const auto& row = work.system.rows[i];
    slope -= row.residual * (work.step.multiplier[i] - row.multiplier + row.penalty * row.residual);
  }
  return slope;
}

/// Shortens the step to keep |x| < 1 and fold angles from jumping.
double step_limit(const Ribbon& ribbon, const NewtonOptions& options, const Chain& chain, const NewtonWorkspace& work) {
  double limit = 1;
  const auto& step = work.step;
  for (std::size_t s = 0; s + 1 < step.u.size(); ++s) {
    const double k = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = k * (chain.eta[s + 1] - chain.eta[s]);
    const double dx = k * (step.u[s + 1][1] - step.u[s][1]);
    const double room = kBoundaryFraction * (dx > 0 ? 1 - x : 1 + x);
    if (limit * std::abs(dx) > room) limit = room / std::abs(dx);
  }
  double turn = step.base.tail<3>().norm();
  for (std::size_t i = 0; i < step.u.size(); ++i) turn = std::max(turn, (work.system.links[i].axes * step.u[i]).norm());
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

/// Largest fold-angle change, displacement / length, and (scaled: it is soft where kappa vanishes) eta change.
double step_size(const Ribbon& ribbon, const NewtonWorkspace& work) {
  double size = 0;
  for (std::size_t i = 0; i < work.step.u.size(); ++i) {
    size = std::max({size, (work.system.links[i].axes * work.step.u[i]).norm(), work.step.v[i].norm() / ribbon.length,
                     1e-3 * std::abs(work.step.u[i][1])});
  }
  return size;
}

double max_abs(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// Solves with the smallest shift of the series that leaves no negative mode; false if none does.
bool find_direction(const Ribbon& ribbon, NewtonWorkspace& work, NewtonReport& report, double& shift) {
  const double l = ribbon.length / ribbon.segments;
  const double unit_kappa = ribbon.bending_stiffness * ribbon.width * l;
  const double unit_eta = ribbon.bending_stiffness * l / ribbon.width;
  shift = shift <= kSmallestShift ? 0 : shift / kShiftFactor;
  while (shift < kLargestShift) {
    work.system.shift = {shift * unit_kappa, shift * unit_eta};
    ++report.sweeps;
    const bool solved = math::chain_step(work.system, work.sweep, work.step);
    if (shift == 0) report.negative_modes = work.step.negative_pivots;
    if (solved && work.step.negative_pivots == 0) return true;
    shift = shift == 0 ? 100 * kSmallestShift : kShiftFactor * shift;
  }
  return false;
}

/// Backtracks along the step on the merit function; leaves the accepted point in the trial buffers.
bool line_search(const Iterate& at, const Chain& chain, double limit, NewtonReport& report) {
  NewtonWorkspace& work = at.work;
  const double start = at.merit_of(chain, work.kinematics, work.residuals);
  const double slope = at.slope();
  const double rounding = 1e-13 * (std::abs(start) + std::abs(slope));
  for (double scale = limit; scale > 1e-10; scale *= 0.5) {
    apply_step(chain, work.step, scale, work.trial);
    geometry::forward_kinematics(at.ribbon, work.trial, work.trial_kinematics);
    ++report.evaluations;
    const double merit = at.merit_of(work.trial, work.trial_kinematics, work.trial_residuals);
    if (std::isfinite(merit) && merit <= start + 1e-4 * scale * slope + rounding) return true;
  }
  return false;
}

/// Pushes the iterate off a stationary point that is no minimum, along the softest direction of the shifted
/// Hessian (inverse iteration from a fixed seed), downhill by the sign of the gradient left over.
bool leave_saddle(const Iterate& at, Chain& current) {
  NewtonWorkspace& work = at.work;
  const std::size_t count = work.system.links.size();
  unsigned seed = 1;
  const auto noise = [&] { return static_cast<double>(seed = seed * 1664525u + 1013904223u) / 4294967296.0 - 0.5; };
  for (auto& row : work.system.rows) row.residual = 0;
  for (int pass = 0; pass < 4; ++pass) {
    for (std::size_t i = 0; i < count; ++i) {
      auto& link = work.system.links[i];
      link.force.setZero();
      link.grad_b.setZero();
      link.grad_a = pass == 0 ? Vec2(noise(), noise()) : Vec2(work.step.u[i]);
      if (!geometry::kappa_is_free(at.ribbon, static_cast<int>(i))) link.grad_a[0] = 0;
      if (!geometry::eta_is_free(at.ribbon, static_cast<int>(i))) link.grad_a[1] = 0;
    }
    work.system.pose_terms.clear();
    if (!math::chain_step(work.system, work.sweep, work.step)) return false;
    double largest = 0;
    for (const Vec2& u : work.step.u) largest = std::max(largest, u.lpNorm<Eigen::Infinity>());
    if (!(largest > 0)) return false;
    for (Vec2& u : work.step.u) u /= largest;
    work.step.base /= largest;
  }
  double turn = 1e-12;
  for (std::size_t i = 0; i < count; ++i) turn = std::max(turn, (work.system.links[i].axes * work.step.u[i]).norm());
  NewtonOptions small;
  small.max_turn = kKick;
  const double scale = std::min(kKick / turn, step_limit(at.ribbon, small, current, work));
  apply_step(current, work.step, scale, work.trial);
  std::swap(current, work.trial);
  geometry::forward_kinematics(at.ribbon, current, work.kinematics);
  return true;
}

}  // namespace

NewtonReport minimise(const Ribbon& ribbon, const ChainProblem& problem, const NewtonOptions& options, Chain& chain,
                      std::vector<double>& multipliers, NewtonWorkspace& work) {
  NewtonReport report;
  Chain current = chain;
  multipliers.resize(row_count(problem), 0.0);
  std::vector<double> lambda = multipliers;
  const Iterate at{ribbon, problem, work};
  double shift = 0;
  geometry::forward_kinematics(ribbon, current, work.kinematics);
  for (; report.iterations < options.max_iterations; ++report.iterations) {
    linearise(ribbon, problem, current, work.kinematics, lambda, work.system);
    if (!find_direction(ribbon, work, report, shift)) {
      report.outcome = NewtonOutcome::singular;
      return report;
    }
    const double limit = step_limit(ribbon, options, current, work);
    report.last_step = step_size(ribbon, work);
    if (shift > 0 && report.last_step < kSaddleStep && report.kicks < 20 && leave_saddle(at, current)) {
      ++report.kicks;
      continue;
    }
    if (!line_search(at, current, limit, report)) {
      report.outcome = NewtonOutcome::line_search_failed;
      return report;
    }
    std::swap(current, work.trial);
    std::swap(work.kinematics, work.trial_kinematics);
    lambda = work.step.multiplier;
    report.max_residual = max_abs(work.trial_residuals);
    if (shift == 0 && limit == 1 && report.last_step < options.tolerance) {
      ++report.iterations;
      report.outcome = NewtonOutcome::converged;
      chain = current;
      multipliers = lambda;
      return report;
    }
  }
  return report;
}

}  // namespace wunderlich::solver
