#include "wunderlich/solver/path_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wunderlich/solver/load_step.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

using std::numbers::pi;
constexpr double kPathBarrier =
    3e-2;  // e1 on the way (with less, twist-pi ends in a higher minimum); then the path's own
constexpr double kSmallestStep = 1.0 / 1024;

void note_origin(const PathProblem& path, PathState& state) {
  Kinematics k;
  geometry::forward_kinematics(ribbon_of(path, state), state.chain, k);
  state.origin.clear();
  for (const auto& support : path.surroundings.supports) {
    const bool at_base = support.segment < 0 && support.node == 0;
    const auto i = static_cast<std::size_t>(held_link(support));
    state.origin.push_back({k.r[static_cast<std::size_t>(support.node)], at_base ? state.chain.base.frame : k.q[i]});
  }
}

}  // namespace

bool is_flat(const Chain& chain, double length, double tolerance) {
  return std::all_of(chain.kappa.begin(), chain.kappa.end(),
                     [&](double kappa) { return std::abs(kappa) * length <= tolerance; });
}

void seed(const Ribbon& ribbon, Chain& chain) {
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const double phase = 2 * pi * ribbon.node_u[i] / ribbon.length;
    if (geometry::kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = -0.3 / ribbon.length * std::cos(phase);
    if (geometry::eta_is_free(ribbon, static_cast<int>(i))) chain.eta[i] = -0.1 * std::sin(phase);
  }
}

Phase next_phase(const PathProblem& path, Phase phase) {
  const bool alone = path.surroundings.supports.empty() && path.surroundings.loads.empty();
  switch (phase) {
    case Phase::bend:
      return Phase::twist;
    case Phase::twist:
      return Phase::close;
    case Phase::close:
      return path.surroundings.contact.self ? Phase::relax : alone ? Phase::done : Phase::approach;
    case Phase::relax:
      return alone ? Phase::done : Phase::approach;
    case Phase::approach:
      return Phase::load;
    case Phase::load:
      return Phase::settle;
    default:
      return Phase::done;
  }
}

void note_frames(const PathProblem& path, PathState& state) {
  Kinematics k;
  geometry::forward_kinematics(ribbon_of(path, state), state.chain, k);
  state.transported.clear();
  for (const auto& support : path.surroundings.supports) {
    state.transported.push_back(holds_base_frame(path.ribbon, support)
                                    ? state.chain.base.frame
                                    : k.q[static_cast<std::size_t>(held_link(support))]);
  }
}

void enter(const PathProblem& path, Phase phase, PathState& state) {
  state.phase = phase;
  state.t = 0;
  state.dt = 0;
  if (phase == Phase::approach) note_origin(path, state);
  note_frames(path, state);
}

std::string why(const NewtonReport& report, const PathState& state) {
  std::string text = std::string(phase_name(state.phase)) + " at t = " + std::to_string(state.t) + ": ";
  switch (report.outcome) {
    case NewtonOutcome::iteration_limit:
      return text + "no convergence in " + std::to_string(report.iterations) +
             " iterations (solver.max_iterations); last step " + std::to_string(report.last_step);
    case NewtonOutcome::line_search_failed:
      return text + "no step lowers the energy; the supports probably ask for more than the strip can reach";
    case NewtonOutcome::singular:
      return text +
             "the linear system is singular; supports may hold the same motion twice, or nothing holds the strip";
    case NewtonOutcome::converged:
      break;
  }
  return text;
}

NewtonOptions newton_options(const PathProblem& path) {
  NewtonOptions options;
  options.tolerance = path.options.tolerance;
  options.max_iterations = path.options.max_iterations;
  return options;
}

void shorten(PathState& state, double planned, PathStep& step) {
  step.failure = why(step.newton, state);
  state.dt *= 0.5;
  step.exhausted = state.dt < kSmallestStep * planned;
}

bool solve_at(const PathProblem& path, PathState& state, double t, const Proximal& proximal, NewtonWorkspace& work,
              PathStep& step) {
  const Ribbon& ribbon = ribbon_of(path, state);
  Chain chain = state.chain;
  std::vector<double> multipliers = state.multipliers;
  ChainProblem problem;
  problem_at(path, state, t, chain, problem);
  NewtonOptions options = newton_options(path);
  if (proximal.passes > 0) {
    if (is_flat(chain, ribbon.length, 0)) seed(ribbon, chain);
    const double l = ribbon.length;
    problem.barrier = std::max(problem.barrier, kPathBarrier);
    const double mass = proximal.mass * ribbon.bending_stiffness * ribbon.width / (l * l * l * l);
    for (const double hinge : ribbon.hinge_length) problem.tie.push_back(mass * hinge);
    options.tolerance = std::max(options.tolerance, 1e-7);
    options.max_iterations = std::min(options.max_iterations, 200);
  }
  if (multipliers.size() != row_count(problem)) multipliers.assign(row_count(problem), 0.0);
  Kinematics k;
  for (int pass = 0; pass < std::max(1, proximal.passes); ++pass) {
    if (proximal.passes > 0) {
      geometry::forward_kinematics(ribbon, chain, k);
      problem.anchor = k.r;
    }
    step.newton = minimise(ribbon, problem, options, chain, multipliers, work);
    step.iterations += step.newton.iterations;
    state.iterations += step.newton.iterations;
    if (!step.newton.converged()) return false;
  }
  state.chain = chain;
  state.multipliers = multipliers;
  state.negative_modes = step.newton.negative_modes;
  return true;
}

}  // namespace wunderlich::solver
