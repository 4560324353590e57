#include <algorithm>
#include <cmath>
#include <numbers>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/path_step.hpp"

namespace wunderlich::solver {

using geometry::Chain;

namespace {

using std::numbers::pi;
constexpr int kBendSteps = 12;         // analytic states, for the film
constexpr double kTwistStep = pi / 4;  // of the end of a ring
// Where the strip feels itself, every turn is made in small steps that its inertia damps, so that it gives way as a
// slow experiment would, and does not jump to whatever minimum is lowest.
constexpr double kCarefulStep = pi / 30;
constexpr double kTwistTime = 0.25;   // of a step's inertia, in sqrt(rho w^4 / D)
constexpr double kLongestTime = 300;  // at the end of relaxing
constexpr double kWideGap = 0.05;     // widths, until it rests
constexpr int kRelaxSteps = 40, kNarrowSteps = 4;
constexpr double kPlanarAmplitude = 15.1;  // of the figure-eight's start, kappa l

/// Isometric states between flat and the start of the loop: a ring, or the planar eight.
void set_bent(const PathProblem& path, double share, Chain& chain) {
  const bool planar = is_planar(path);
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const double phase = 2 * pi * path.cut.node_u[i] / path.cut.length;
    chain.kappa[i] = share / path.cut.length * (planar ? kPlanarAmplitude * std::cos(phase) : 2 * pi);
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

namespace {

/// One minimisation of the strip alone: as it lies, or (`time` > 0) as far as inertia lets it come within a time, in
/// units of the time in which bending crosses the strip's width. It feels itself from `gap` widths on.
PathStep move_alone(const PathProblem& path, const PathState& state, ChainProblem& problem, double time, double gap,
                    PathState& next, NewtonWorkspace& work) {
  const geometry::Ribbon& ribbon = ribbon_of(path, next);
  const double w = path.ribbon.width, reach = std::max(path.surroundings.contact.distance, gap * w);
  problem.model = path.options.model;
  problem.barrier = path.options.barrier;
  problem.force.assign(next.chain.kappa.size(), Vec3::Zero());
  problem.base_fixed.fill(true);
  problem.closed = next.closed;
  place_self(path.ribbon, path.surroundings, reach, next.closed, state.chain.eta, problem.self);
  if (time > 0) {
    const double tie = path.ribbon.bending_stiffness / (time * time * w * w * w);
    for (const double h : ribbon.hinge_length) problem.tie.push_back(tie * h);
    geometry::Kinematics k;
    geometry::forward_kinematics(ribbon, next.chain, k);
    problem.anchor = k.r;
  }
  PathStep step;
  next.multipliers.resize(row_count(problem), 0.0);
  step.newton = minimise(ribbon, problem, newton_options(path), next.chain, next.multipliers, work);
  step.accepted = step.newton.converged();
  step.iterations = step.newton.iterations;
  next.iterations += step.iterations;
  next.negative_modes = step.newton.negative_modes;
  if (!step.accepted) step.failure = why(step.newton, state);
  return step;
}

}  // namespace

/// Turns the end of the ring about the tangent while its position stays at the start's.
PathStep twist_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const double total = path.ribbon.half_twists * pi;
  const bool feels = path.surroundings.contact.self;
  const double planned = total == 0 ? 1 : std::min(1.0, (feels ? kCarefulStep : kTwistStep) / std::abs(total));
  if (state.dt == 0) state.dt = planned;
  const double t = std::min(1.0, state.t + state.dt);
  PathState next = state;
  ChainProblem problem;
  Hold hold;
  hold.node = path.cut.segments;
  hold.target = {state.chain.base.position, state.chain.base.frame * math::exp_map(Vec3(0, 0, t * total))};
  problem.holds = {hold};
  PathStep step = move_alone(path, state, problem, feels ? kTwistTime : 0, kWideGap, next, work);
  state.iterations = next.iterations;
  if (!step.accepted) {
    shorten(state, 1, step);
    return step;
  }
  state = next;
  state.clock += t - state.t;
  state.t = t;
  if (t == 1) enter(path, Phase::close, state);
  return step;
}

/// Joins the two half hinges at the seam to one and lets the seam go.
PathStep close_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const geometry::State open = geometry::state_of(path.cut, state.chain, 0);
  PathState next = state;
  next.closed = true;
  next.chain = geometry::chain_of(path.ribbon, open);
  next.chain.eta.back() = path.ribbon.seam_sign() * next.chain.eta.front();
  next.multipliers.clear();
  ChainProblem problem;
  PathStep step =
      move_alone(path, next, problem, path.surroundings.contact.self ? kTwistTime : 0, kWideGap, next, work);
  state.iterations = next.iterations;
  step.exhausted = !step.accepted;
  if (!step.accepted) return step;
  state = next;
  state.clock += 1;
  enter(path, next_phase(path, Phase::close), state);
  return step;
}

/// Lets a closed loop that feels itself come to rest, in longer and longer steps of its inertia, then without any, and
/// narrows the gap at which forces begin.
PathStep relax_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const int count = kRelaxSteps + kNarrowSteps, k = static_cast<int>(std::lround(state.t * count));
  const bool rests = k >= kRelaxSteps;
  const double time = rests ? 0 : kTwistTime * std::pow(kLongestTime / kTwistTime, 1.0 * k / (kRelaxSteps - 1));
  const double last = path.surroundings.contact.distance / path.ribbon.width;
  const double share = rests ? static_cast<double>(k - kRelaxSteps + 1) / kNarrowSteps : 0;
  PathState next = state;
  ChainProblem problem;
  PathStep step = move_alone(path, state, problem, time, kWideGap * std::pow(last / kWideGap, share), next, work);
  state.iterations = next.iterations;
  step.exhausted = !step.accepted;
  if (!step.accepted) return step;
  state = next;
  state.t = static_cast<double>(k + 1) / count;
  state.clock += 1.0 / count;
  if (k + 1 == count) enter(path, next_phase(path, Phase::relax), state);
  return step;
}

}  // namespace wunderlich::solver
