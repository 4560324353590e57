#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/path_step.hpp"

namespace wunderlich::solver {

using geometry::Chain;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kBendSteps = 12;             // analytic states, for the film
constexpr double kTwistStep = kPi / 4;     // of the end of a ring
constexpr double kPlanarAmplitude = 15.1;  // of the figure-eight's start, kappa l

/// Isometric states between flat and the start of the loop: a ring, or the planar eight.
void set_bent(const PathProblem& path, double share, Chain& chain) {
  const bool planar = is_planar(path);
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const double phase = 2 * kPi * path.cut.node_u[i] / path.cut.length;
    chain.kappa[i] = share / path.cut.length * (planar ? kPlanarAmplitude * std::cos(phase) : 2 * kPi);
  }
}

}  // namespace

bool is_planar(const PathProblem& path) {
  const LoopPath wish = path.options.loop_path;
  return wish == LoopPath::planar || (wish == LoopPath::automatic && std::abs(path.ribbon.half_twists) == 2);
}

PathStep bend_step(const PathProblem& path, PathState& state) {
  const int next = static_cast<int>(std::lround(state.t * kBendSteps)) + 1;
  state.t = static_cast<double>(next) / kBendSteps;
  state.clock = state.t;
  set_bent(path, state.t, state.chain);
  if (next == kBendSteps) enter(path, is_planar(path) ? Phase::close : Phase::twist, state);
  PathStep step;
  step.accepted = true;
  return step;
}

/// Turns the end of the ring about the tangent while its position stays at the start's.
PathStep twist_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const double total = path.ribbon.half_twists * kPi;
  if (state.dt == 0) state.dt = total == 0 ? 1 : std::min(1.0, kTwistStep / std::abs(total));
  const double t = std::min(1.0, state.t + state.dt);
  Chain chain = state.chain;
  std::vector<double> multipliers = state.multipliers;
  ChainProblem problem;
  problem.model = path.options.model;
  problem.barrier = path.options.barrier;
  problem.force.assign(chain.kappa.size(), Vec3::Zero());
  problem.base_fixed.fill(true);
  Hold hold;
  hold.node = path.cut.segments;
  hold.target = {chain.base.position, chain.base.frame * math::exp_map(Vec3(0, 0, t * total))};
  problem.holds = {hold};
  PathStep step;
  step.newton = minimise(path.cut, problem, newton_options(path), chain, multipliers, work);
  step.iterations = step.newton.iterations;
  state.iterations += step.iterations;
  if (!step.newton.converged()) {
    shorten(state, 1, step);
    return step;
  }
  state.chain = chain;
  state.multipliers = multipliers;
  state.clock += t - state.t;
  state.t = t;
  step.accepted = true;
  if (t == 1) enter(path, Phase::close, state);
  return step;
}

/// Joins the two half hinges at the seam to one and lets the seam go.
PathStep close_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const geometry::State open = geometry::state_of(path.cut, state.chain, 0);
  PathState closed = state;
  closed.closed = true;
  closed.chain = geometry::chain_of(path.ribbon, open);
  closed.chain.eta.back() = path.ribbon.seam_sign() * closed.chain.eta.front();
  closed.multipliers.clear();
  const PathProblem alone{path.ribbon, path.cut, {}, path.options};
  PathStep step;
  step.accepted = solve_at(alone, closed, 0, {}, work, step);
  if (!step.accepted) {
    step.failure = why(step.newton, state);
    step.exhausted = true;
    state.iterations = closed.iterations;
    return step;
  }
  state = closed;
  state.clock += 1;
  enter(path, next_phase(path, Phase::close), state);
  return step;
}

}  // namespace wunderlich::solver
