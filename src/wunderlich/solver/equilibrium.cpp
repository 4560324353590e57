#include "wunderlich/solver/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/load_step.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kBendSteps = 12;           // analytic states, for the film
constexpr double kTwistStep = kPi / 4;   // of the end of a ring
constexpr double kMotionStep = 0.08;     // of a support between two places that are held [rad, lengths]
constexpr int kProximalPasses = 3;       // minimisations with a fictitious mass a load step
constexpr double kProximity = 1e4;       // that mass, in units of D w / l^4 per length
constexpr double kPathBarrier = 1e-3;    // e1 on the way; the final state has the path's own
constexpr double kPlanarAmplitude = 15.1;   // of the figure-eight's start, kappa l
constexpr double kSmallestStep = 1.0 / 1024;
constexpr int kSettleRounds = 30;
constexpr double kSettleTime = 0.05;     // on the clock of the path, for the film

Phase next_phase(const PathProblem& path, Phase phase) {
  const bool alone = path.surroundings.supports.empty() && path.surroundings.loads.empty();
  switch (phase) {
    case Phase::bend: return Phase::twist;
    case Phase::twist: return Phase::close;
    case Phase::close: return alone ? Phase::done : Phase::approach;
    case Phase::approach: return Phase::load;
    case Phase::load: return Phase::settle;
    default: return Phase::done;
  }
}

bool is_planar(const PathProblem& path) {
  const LoopPath wish = path.options.loop_path;
  return wish == LoopPath::planar || (wish == LoopPath::automatic && std::abs(path.ribbon.half_twists) == 2);
}

/// Isometric states between flat and the start of the loop: a ring, or the planar eight.
void set_bent(const PathProblem& path, double share, Chain& chain) {
  const bool planar = is_planar(path);
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const double phase = 2 * kPi * path.cut.node_u[i] / path.cut.length;
    chain.kappa[i] = share / path.cut.length * (planar ? kPlanarAmplitude * std::cos(phase) : 2 * kPi);
  }
}

/// A flat strip between two held places can leave the plane either way, and its rulings are undetermined: a small
/// bow and slope decide both.
void seed(const Ribbon& ribbon, Chain& chain) {
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const double phase = 2 * kPi * ribbon.node_u[i] / ribbon.length;
    if (geometry::kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = -0.3 / ribbon.length * std::cos(phase);
    if (geometry::eta_is_free(ribbon, static_cast<int>(i))) chain.eta[i] = -0.1 * std::sin(phase);
  }
}

bool is_flat(const Chain& chain) {
  return std::all_of(chain.kappa.begin(), chain.kappa.end(), [](double k) { return k == 0; });
}

/// Between two held places flat strips buckle and snap: go there with a fictitious mass, in small steps.
bool is_proximal(const PathProblem& path) { return path.surroundings.supports.size() > 1; }

void note_frames(const PathProblem& path, PathState& state) {
  Kinematics k;
  geometry::forward_kinematics(ribbon_of(path, state), state.chain, k);
  state.transported.clear();
  for (const auto& support : path.surroundings.supports) {
    state.transported.push_back(k.q[static_cast<std::size_t>(held_link(support))]);
  }
}

void note_origin(const PathProblem& path, PathState& state) {
  Kinematics k;
  geometry::forward_kinematics(ribbon_of(path, state), state.chain, k);
  state.origin.clear();
  for (const auto& support : path.surroundings.supports) {
    const bool at_base = support.segment < 0 && support.node == 0;
    const auto i = static_cast<std::size_t>(held_link(support));
    state.origin.push_back({k.r[i], at_base ? state.chain.base.frame : k.q[i]});
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
      return text + "the linear system is singular; supports may hold the same motion twice, or nothing holds the strip";
    case NewtonOutcome::converged: break;
  }
  return text;
}

NewtonOptions newton_options(const PathProblem& path) {
  NewtonOptions options;
  options.tolerance = path.options.tolerance;
  options.max_iterations = path.options.max_iterations;
  return options;
}

/// After a failed step: half the length next time, unless it is too short already.
void shorten(PathState& state, double planned, PathStep& step) {
  step.failure = why(step.newton, state);
  state.dt *= 0.5;
  step.exhausted = state.dt < kSmallestStep * planned;
}

/// One minimisation from the state's chain at parameter t; the chain and multipliers change only on success.
bool solve_at(const PathProblem& path, PathState& state, double t, int proximal_passes, double proximity,
              NewtonWorkspace& work, PathStep& step) {
  const Ribbon& ribbon = ribbon_of(path, state);
  Chain chain = state.chain;
  std::vector<double> multipliers = state.multipliers;
  ChainProblem problem = problem_at(path, state, t, chain);
  NewtonOptions options = newton_options(path);
  if (proximal_passes > 0) {
    if (is_flat(chain)) seed(ribbon, chain);
    const double l = ribbon.length;
    problem.barrier = std::max(problem.barrier, kPathBarrier);
    problem.proximity = proximity * ribbon.bending_stiffness * ribbon.width / (l * l * l * l);
    options.tolerance = std::max(options.tolerance, 1e-7);
    options.max_iterations = std::min(options.max_iterations, 200);
  }
  if (multipliers.size() != row_count(problem)) multipliers.assign(row_count(problem), 0.0);
  Kinematics k;
  for (int pass = 0; pass < std::max(1, proximal_passes); ++pass) {
    if (proximal_passes > 0) {
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

/// Steps of the phase under way: their number if nothing fails.
double planned_step(const PathProblem& path, const PathState& state) {
  const double duration = path.options.duration;
  if (state.phase == Phase::approach) return is_proximal(path) ? 0.05 : 1;
  if (path.options.steps > 0) return duration / path.options.steps;
  const double way = motion_between(path, 0, duration);
  const int count = is_proximal(path) ? static_cast<int>(std::ceil(way / kMotionStep)) : 1;
  return duration / std::clamp(count, path.surroundings.loads.empty() ? 1 : 4, 4000);
}

/// Does the approach have anything to do: a target away from the strip's own pose, or a load at once.
bool needs_approach(const PathProblem& path, const PathState& state) {
  if (!path.surroundings.gravity.isZero()) return true;
  for (std::size_t i = 0; i < path.surroundings.supports.size(); ++i) {
    const auto& support = path.surroundings.supports[i];
    const Pose goal = constraint::pose_at(support.motion, 0);
    const Pose& own = state.origin[i];
    for (int c = 0; c < 3; ++c) {
      const double gap = std::abs(goal.position[c] - own.position[c]);
      if (support.hold_position[static_cast<std::size_t>(c)] && gap > 1e-12 * path.ribbon.length) return true;
    }
    if (support.orientation != constraint::Orientation::free && own.frame.angularDistance(goal.frame) > 1e-12) return true;
  }
  const auto& loads = path.surroundings.loads;
  return std::any_of(loads.begin(), loads.end(), [](const constraint::Load& load) {
    const auto key = constraint::load_at(load, 0);
    return !key.force.isZero() || !key.torque.isZero();
  });
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
  step.accepted = solve_at(alone, closed, 0, 0, 0, work, step);
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

PathStep load_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const double end = state.phase == Phase::approach ? 1 : path.options.duration;
  PathStep step;
  if (state.phase == Phase::approach && !needs_approach(path, state)) {
    enter(path, Phase::load, state);
    step.accepted = true;
    return step;
  }
  const double planned = planned_step(path, state);
  if (state.dt == 0) state.dt = planned;
  double t = state.t + state.dt;
  if (t > end - 1e-9 * state.dt) t = end;
  const int passes = is_proximal(path) ? kProximalPasses : 0;
  step.accepted = solve_at(path, state, t, passes, kProximity, work, step);
  if (!step.accepted) {
    shorten(state, planned, step);
    return step;
  }
  state.clock += t - state.t;
  state.t = t;
  note_frames(path, state);
  state.dt = std::min(planned, 1.5 * state.dt);
  if (t == end) enter(path, next_phase(path, state.phase), state);
  return step;
}

/// The static minimum at the end of the path; where Newton does not reach it at once, proximal steps with less and
/// less fictitious mass come closer first. `t` counts those.
PathStep settle_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  PathStep step;
  const double end = path.options.duration;
  step.accepted = solve_at(path, state, end, 0, 0, work, step);
  if (step.accepted) {
    enter(path, Phase::done, state);
    state.clock += kSettleTime;
    return step;
  }
  step.failure = why(step.newton, state);
  if (state.t >= kSettleRounds) {
    step.exhausted = true;
    return step;
  }
  const double mass = kProximity * std::pow(0.5, state.t);
  step.accepted = solve_at(path, state, end, kProximalPasses, mass, work, step);
  step.exhausted = !step.accepted;
  state.clock += kSettleTime;
  state.t += 1;
  note_frames(path, state);
  return step;
}

}  // namespace

const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::bend: return "bend";
    case Phase::twist: return "twist";
    case Phase::close: return "close";
    case Phase::approach: return "approach";
    case Phase::load: return "load";
    case Phase::settle: return "settle";
    case Phase::done: return "done";
  }
  return "";
}

PathProblem make_path(const Ribbon& ribbon, const constraint::Surroundings& surroundings, const PathOptions& options) {
  PathProblem path{ribbon, ribbon, surroundings, options};
  if (ribbon.is_loop()) {
    geometry::RibbonSpec spec{ribbon.length, ribbon.width, ribbon.segments, ribbon.bending_stiffness,
                              ribbon.area_density};
    spec.clamped = {true, true};
    spec.spacing = ribbon.rest_length;
    path.cut = geometry::make_ribbon(spec);
  }
  return path;
}

PathState start_path(const PathProblem& path) {
  const geometry::State straight = geometry::straight_state(path.ribbon);
  Pose base{Vec3::Zero(), straight.q.front()};
  // Start on the first support, so that an approach is the exception.
  if (!path.ribbon.is_loop() && !path.surroundings.supports.empty()) {
    const constraint::Support& first = path.surroundings.supports.front();
    const Pose pose = constraint::pose_at(first.motion, 0);
    if (first.orientation != constraint::Orientation::free) base.frame = pose.frame;
    const double u = path.ribbon.node_u[static_cast<std::size_t>(held_link(first))];
    base.position = pose.position - u * (base.frame * Vec3::UnitZ());
  }
  PathState state;
  state.chain = geometry::straight_chain(path.cut, base);
  enter(path, path.ribbon.is_loop() ? Phase::bend : Phase::approach, state);
  return state;
}

PathStep advance(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  PathStep step;
  switch (state.phase) {
    case Phase::bend: step = bend_step(path, state); break;
    case Phase::twist: step = twist_step(path, state, work); break;
    case Phase::close: step = close_step(path, state, work); break;
    case Phase::approach:
    case Phase::load: step = load_step(path, state, work); break;
    case Phase::settle: step = settle_step(path, state, work); break;
    case Phase::done: break;
  }
  if (step.accepted) ++state.steps;
  return step;
}

double fraction_done(const PathProblem& path, const PathState& state) {
  switch (state.phase) {
    case Phase::bend: return 0.1 * state.t;
    case Phase::twist: return 0.1 + 0.4 * state.t;
    case Phase::close: return 0.5;
    case Phase::approach: return path.ribbon.is_loop() ? 0.6 + 0.1 * state.t : 0.1 * state.t;
    case Phase::load: return 0.1 + 0.8 * state.t / path.options.duration;
    case Phase::settle: return 0.9;
    case Phase::done: return 1;
  }
  return 0;
}

const Ribbon& ribbon_of(const PathProblem& path, const PathState& state) {
  return state.closed ? path.ribbon : path.cut;
}

double elastic_energy(const Ribbon& ribbon, const energy::Model& model, const Chain& chain) {
  ChainProblem problem;
  problem.model = model;
  problem.barrier = 0;
  problem.force.assign(chain.kappa.size(), Vec3::Zero());
  Kinematics k;
  geometry::forward_kinematics(ribbon, chain, k);
  return objective(ribbon, problem, chain, k, k).elastic;
}

EndReactions end_reactions(const PathProblem& path, const PathState& state, NewtonWorkspace& work) {
  const Ribbon& ribbon = ribbon_of(path, state);
  Chain chain = state.chain;
  PathState settled = state;
  settled.phase = Phase::settle;
  const ChainProblem problem = problem_at(path, settled, path.options.duration, chain);
  EndReactions reactions;
  if (state.multipliers.size() != row_count(problem)) return reactions;
  geometry::forward_kinematics(ribbon, chain, work.kinematics);
  linearise(ribbon, problem, chain, work.kinematics, state.multipliers, work.system);
  if (!math::chain_step(work.system, work.sweep, work.step)) return reactions;
  // A held base answers with the gradient of everything beyond it; a held pose with minus its multipliers.
  if (base_is_held(path)) {
    reactions.force[0] = work.sweep.base_gradient.head<3>();
    reactions.torque[0] = work.sweep.base_gradient.tail<3>();
  }
  for (const math::ChainRow& row : work.system.rows) {
    if (row.node != 0 && row.node != ribbon.segments) continue;
    const std::size_t end = row.node == 0 ? 0 : 1;
    reactions.force[end] -= row.multiplier * row.v;
    reactions.torque[end] -= row.multiplier * row.theta;
  }
  return reactions;
}

}  // namespace wunderlich::solver
