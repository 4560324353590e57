#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "wunderlich/baseline/rod/newton.hpp"

namespace wunderlich::baseline::rod {

namespace {

constexpr int kMostRounds = 60;       // of Newton's method; near a balance it takes a handful
constexpr double kLeastShare = 1e-4;  // of a step
constexpr double kAdvance = 0.25;     // of what a step promises that must come true

bool factor_jacobian(Workspace& work) {
  math::GeneralBanded& jacobian = work.jacobian;
  const int size = work.system.hessian.size, width = work.system.hessian.bandwidth;
  jacobian.reset(size, width);
  for (int j = 0; j < size; ++j) {
    for (int i = j; i <= std::min(size - 1, j + width); ++i)
      jacobian.at(i, j) = jacobian.at(j, i) = work.system.hessian.at(i, j);
  }
  for (const System::Entry& entry : work.system.follower) jacobian.at(entry.row, entry.column) += entry.value;
  return math::factor(jacobian);
}

/// Newton's step from the last factors, and its length in the metric.
double newton_step(const std::vector<double>& gradient, Workspace& work, std::vector<double>& step) {
  step.resize(gradient.size());
  for (std::size_t k = 0; k < step.size(); ++k) step[k] = -gradient[k];
  math::solve(work.jacobian, step);
  double sum = 0;
  for (std::size_t k = 0; k < step.size(); ++k) sum += work.metric[k] * step[k] * step[k];
  return std::sqrt(sum);
}

/// Calls visit(k, strain, stiffness, slope, coordinates) for every measure of strain; k is its stress's place.
template <class Visit>
void for_measures(const Rod& rod, const State& state, const Visit& visit) {
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const Vec3 e = state.x[j + 1] - state.x[j], along = e.normalized();
    Eigen::Matrix<double, 6, 1> slope;
    slope << -along, along;
    const std::size_t i = 4 * j;
    visit(j, e.norm() - rod.rest_length[j], rod.stiffness.stretch / rod.rest_length[j], slope,
          std::array<std::size_t, 6>{i, i + 1, i + 2, i + 4, i + 5, i + 6});
  }
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const Measures at = measures(rod, state, i);
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k)
      visit(rod.edges() + 5 * i + k, at.strain[k], at.stiffness[k], at.slope[k], hinge_coordinates(rod, i));
  }
}

/// Stresses that strains give.
void own_stresses(const Rod& rod, const State& at, std::vector<double>& stress) {
  stress.assign(rod.edges() + 5 * rod.nodes(), 0.0);
  for_measures(rod, at, [&](std::size_t k, double strain, double stiffness, const auto&, const auto&) {
    stress[k] = stiffness * strain;
  });
}

/// What the step in `work.increment` makes of the stresses, were strains to change as they do to first order.
void step_stresses(const Rod& rod, const State& at, Workspace& work) {
  work.stress_step.assign(work.stress.size(), 0.0);
  for_measures(rod, at, [&](std::size_t k, double strain, double stiffness, const auto& slope, const auto& places) {
    for (std::size_t c = 0; c < places.size(); ++c) strain += slope[static_cast<int>(c)] * work.increment[places[c]];
    work.stress_step[k] = stiffness * strain - work.stress[k];
  });
}

/// Forces at the trial state as the factors at `at` know how to answer them: a stress that strains contradict is put
/// right along slopes as they were.
void find_rest(const Rod& rod, const State& before, Workspace& work) {
  work.rest = work.trial_system.gradient;
  const auto add = [&](double defect, const auto& slope, const auto& places) {
    for (std::size_t c = 0; c < places.size(); ++c) {
      const int row = work.unknowns.number[places[c]];
      if (row >= 0) work.rest[static_cast<std::size_t>(row)] += defect * slope[static_cast<int>(c)];
    }
  };
  work.defect.resize(work.stress.size());
  for_measures(rod, work.trial,
               [&](std::size_t k, double strain, double stiffness, const auto& slope, const auto& places) {
                 work.defect[k] = work.trial_stress[k] - stiffness * strain;
                 add(work.defect[k], slope, places);
               });
  for_measures(rod, before, [&](std::size_t k, double, double, const auto& slope, const auto& places) {
    add(-work.defect[k], slope, places);
  });
}

/// Goes along the step in `work.increment` as far as the next one, from the same factors, is shorter; its system is
/// then in `work.system`.   @eq Deuflhard2011
bool advance(const Rod& rod, double share, double length, State& at, Workspace& work) {
  step_stresses(rod, at, work);
  work.trial_stress.resize(work.stress.size());
  for (; share > kLeastShare; share *= 0.5) {
    move(rod, at, work.increment, share, work.trial);
    if (!std::isfinite(value(rod, work.objective, work.trial))) continue;
    for (std::size_t k = 0; k < work.stress.size(); ++k)
      work.trial_stress[k] = work.stress[k] + share * work.stress_step[k];
    assemble(rod, work.objective, work.trial, work.unknowns, work.trial_system, work.trial_stress);
    find_rest(rod, at, work);
    if (newton_step(work.rest, work, work.mode) > (1 - kAdvance * share) * length) continue;
    swap_shapes(at, work.trial);
    std::swap(work.system, work.trial_system);
    std::swap(work.stress, work.trial_stress);
    return true;
  }
  return false;
}

/// Moves what supports move, all else along as the linearised rod follows. False if that is too far or barred.
bool carry_along(const Rod& rod, State& at, Workspace& work) {
  newton_step(work.system.gradient, work, work.step);
  expand(work.unknowns, work.step, 1, work.increment);
  if (size_of(rod, work.increment).share < 1) return false;
  std::fill(work.unknowns.given.begin(), work.unknowns.given.end(), 0.0);
  step_stresses(rod, at, work);
  for (std::size_t k = 0; k < work.stress.size(); ++k) work.stress[k] += work.stress_step[k];
  move(rod, at, work.increment, 1, work.trial);
  swap_shapes(at, work.trial);
  assemble(rod, work.objective, at, work.unknowns, work.system, work.stress);
  return std::isfinite(value(rod, work.objective, at));
}

}  // namespace

Report balance(const Rod& rod, State& state, Workspace& work) {
  Report report;
  State at = state;
  find_metric(rod, work.unknowns, work.metric);
  bool supports_move = supports_moved(work.unknowns);
  own_stresses(rod, at, work.stress);
  assemble(rod, work.objective, at, work.unknowns, work.system, work.stress);
  while (report.iterations < kMostRounds) {
    ++report.iterations;
    report.outcome = Outcome::singular;
    if (!factor_jacobian(work)) return report;
    report.outcome = Outcome::blocked;
    if (supports_move && !carry_along(rod, at, work)) return report;
    if (std::exchange(supports_move, false)) continue;
    const double length = newton_step(work.system.gradient, work, work.step);
    expand(work.unknowns, work.step, 0, work.increment);
    const Size size = size_of(rod, work.increment);
    if (size.step <= kLastStep) {
      move(rod, at, work.increment, 1, work.trial);
      swap_shapes(state, std::isfinite(value(rod, work.objective, work.trial)) ? work.trial : at);
      report.outcome = Outcome::converged;
      return report;
    }
    report.outcome = Outcome::stalled;
    if (!advance(rod, size.share, length, at, work)) return report;
  }
  report.outcome = Outcome::iteration_limit;
  return report;
}

}  // namespace wunderlich::baseline::rod
