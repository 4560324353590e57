#include "wunderlich/solver/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/load_step.hpp"
#include "wunderlich/solver/path_step.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kMotionStep = 0.08;  // of a support between two places that are held [rad, lengths]
constexpr double kLargestTurn = 1;    // of a support in one load step [rad]
constexpr int kProximalPasses = 3;    // minimisations with a fictitious mass a load step
constexpr double kProximity = 1e4;    // that mass, in units of D w / l^4 per length
constexpr int kSettleRounds = 30;
constexpr int kMaxSteps = 5000;         // of a path whose orientation constraints do not come to rest
constexpr double kTurnedAtRest = 1e-9;  // of a tangent between two solutions at rest [rad]

/// Between two held places flat strips buckle and snap: go there with a fictitious mass, in small steps.
bool is_proximal(const PathProblem& path) { return path.surroundings.supports.size() > 1; }

/// Steps of the phase under way: their number if nothing fails.
double planned_step(const PathProblem& path, const PathState& state) {
  const double duration = path.options.duration;
  if (state.phase == Phase::approach) return is_proximal(path) ? 0.05 : 1;
  const double way = motion_between(path, 0, duration);
  // A frame cannot tell a whole turn from none: no step, also of the user's choice, may turn a support that far.
  if (path.options.steps > 0) return duration / std::max<double>(path.options.steps, std::ceil(way / kLargestTurn));
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
    if (support.orientation != constraint::Orientation::free && own.frame.angularDistance(goal.frame) > 1e-12)
      return true;
  }
  const auto& loads = path.surroundings.loads;
  return std::any_of(loads.begin(), loads.end(), [](const constraint::Load& load) {
    const auto key = constraint::load_at(load, 0);
    return !key.force.isZero() || !key.torque.isZero();
  });
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
  const Proximal proximal = is_proximal(path) ? Proximal{kProximalPasses, kProximity} : Proximal{};
  step.accepted = solve_at(path, state, t, proximal, work, step);
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

/// Takes the strip's frames for the next reference of the orientation constraints; says how far their tangents had
/// turned against the last one [rad]. At rest they have not: only then is the constraint's torque about the tangent.
double renew_frames(const PathProblem& path, PathState& state) {
  const std::vector<Quat> before = state.transported;
  note_frames(path, state);
  double turned = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (path.surroundings.supports[i].orientation != constraint::Orientation::about_tangent) continue;
    turned = std::max(turned, (before[i] * Vec3::UnitZ() - state.transported[i] * Vec3::UnitZ()).norm());
  }
  return turned;
}

/// The static minimum at the end of the path; where Newton does not reach it at once, proximal steps with less and
/// less fictitious mass come closer first. `t` counts those.
PathStep settle_step(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  PathStep step;
  const double end = path.options.duration;
  step.accepted = solve_at(path, state, end, {}, work, step);
  if (step.accepted) {
    if (renew_frames(path, state) < kTurnedAtRest) {
      enter(path, Phase::done, state);
    } else if (state.steps > kMaxSteps) {
      step.exhausted = true;
      step.failure = "settle: the frames that orientation constraints are carried along with do not come to rest";
    }
    state.clock += kSettleTime;
    return step;
  }
  step.failure = why(step.newton, state);
  if (state.t >= kSettleRounds) {
    step.exhausted = true;
    return step;
  }
  const double mass = kProximity * std::pow(0.5, state.t);
  step.accepted = solve_at(path, state, end, {kProximalPasses, mass}, work, step);
  step.exhausted = !step.accepted;
  state.clock += kSettleTime;
  state.t += 1;
  note_frames(path, state);
  return step;
}

/// What the strip touches now, and how near it has come.
void note_contact(const PathProblem& path, PathState& state, NewtonWorkspace& work) {
  const constraint::Surroundings& surroundings = path.surroundings;
  if (surroundings.obstacles.empty() && !surroundings.contact.self) return;
  const Ribbon& ribbon = ribbon_of(path, state);
  ChainProblem problem;
  Chain chain = state.chain;
  const bool over = state.phase == Phase::settle || state.phase == Phase::done;
  problem_at(path, state, over ? path.options.duration : state.t, chain, problem);
  geometry::forward_kinematics(ribbon, state.chain, work.kinematics);
  find_touching(ribbon, problem.touchable(), state.chain, work.kinematics, work.search, work.touching);
  state.touching = contact_count(problem.touchable(), work.touching);
  state.nearest = std::min(state.nearest, smallest_distance(problem.touchable(), work.touching));
}

}  // namespace

const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::bend:
      return "bend";
    case Phase::twist:
      return "twist";
    case Phase::close:
      return "close";
    case Phase::relax:
      return "relax";
    case Phase::approach:
      return "approach";
    case Phase::load:
      return "load";
    case Phase::settle:
      return "settle";
    case Phase::done:
      return "done";
  }
  return "";
}

PathProblem make_path(const Ribbon& ribbon, const constraint::Surroundings& surroundings, const PathOptions& options) {
  PathProblem path{ribbon, ribbon, surroundings, options};
  if (ribbon.is_loop()) {
    geometry::RibbonSpec spec;
    spec.length = ribbon.length;
    spec.width = ribbon.width;
    spec.segments = ribbon.segments;
    spec.bending_stiffness = ribbon.bending_stiffness;
    spec.area_density = ribbon.area_density;
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
    const double u = path.ribbon.node_u[static_cast<std::size_t>(first.node)];
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
    case Phase::bend:
      step = bend_step(path, state);
      break;
    case Phase::twist:
      step = twist_step(path, state, work);
      break;
    case Phase::close:
      step = close_step(path, state, work);
      break;
    case Phase::relax:
      step = relax_step(path, state, work);
      break;
    case Phase::approach:
    case Phase::load:
      step = load_step(path, state, work);
      break;
    case Phase::settle:
      step = settle_step(path, state, work);
      break;
    case Phase::done:
      break;
  }
  if (step.accepted) ++state.steps;
  if (step.accepted) note_contact(path, state, work);
  return step;
}

double fraction_done(const PathProblem& path, const PathState& state) {
  switch (state.phase) {
    case Phase::bend:
      return 0.1 * state.t;
    case Phase::twist:
      return 0.1 + 0.4 * state.t;
    case Phase::close:
      return 0.5;
    case Phase::relax:
      return 0.5 + 0.4 * state.t;
    case Phase::approach:
      return path.ribbon.is_loop() ? 0.6 + 0.1 * state.t : 0.1 * state.t;
    case Phase::load:
      return 0.1 + 0.8 * state.t / path.options.duration;
    case Phase::settle:
      return 0.9;
    case Phase::done:
      return 1;
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

namespace {

/// The problem where the path stands, linearised there with its multipliers; left in the workspace. False if it is
/// singular, or if there is none yet.
bool linearise_at(const PathProblem& path, const PathState& state, ChainProblem& problem, NewtonWorkspace& work) {
  const Ribbon& ribbon = ribbon_of(path, state);
  Chain chain = state.chain;
  PathState settled = state;
  const bool over = state.phase == Phase::settle || state.phase == Phase::done;
  settled.phase = over ? Phase::settle : state.phase;
  problem_at(path, settled, over ? path.options.duration : state.t, chain, problem);
  if (state.multipliers.size() != row_count(problem)) return false;
  geometry::forward_kinematics(ribbon, chain, work.kinematics);
  find_touching(ribbon, problem.touchable(), chain, work.kinematics, work.search, work.touching);
  linearise(ribbon, problem, chain, work.kinematics, state.multipliers, work.touching, work.system);
  return math::chain_step(work.system, work.sweep, work.step);
}

}  // namespace

EndReactions end_reactions(const PathProblem& path, const PathState& state, NewtonWorkspace& work) {
  ChainProblem problem;
  EndReactions reactions;
  if (!linearise_at(path, state, problem, work)) return reactions;
  // A held base answers with the gradient of everything beyond it; a held pose with minus its multipliers.
  if (base_is_held(path)) {
    reactions.force[0] = work.sweep.base_gradient.head<3>();
    reactions.torque[0] = work.sweep.base_gradient.tail<3>();
  }
  // After the probes of the loads, the rows of each hold in turn.
  auto row =
      work.system.rows.begin() + static_cast<std::ptrdiff_t>(work.system.probe_count() + (problem.closed ? 8 : 0));
  for (const Hold& hold : problem.holds) {
    for (std::size_t k = 0; k < row_count(hold); ++k, ++row) {
      if (hold.end < 0) continue;
      reactions.force[static_cast<std::size_t>(hold.end)] -= row->multiplier * row->v;
      reactions.torque[static_cast<std::size_t>(hold.end)] -= row->multiplier * (row->theta + row->base_theta);
    }
  }
  return reactions;
}

std::optional<double> joint_imbalance(const PathProblem& path, const PathState& state, NewtonWorkspace& work) {
  ChainProblem problem;
  if (!linearise_at(path, state, problem, work)) return std::nullopt;
  const Ribbon& ribbon = ribbon_of(path, state);
  double largest = 0;
  for (std::size_t i = 0; i < work.sweep.gradient.size(); ++i) {
    const Vec2& gradient = work.sweep.gradient[i];
    const double fold = geometry::fold_length(ribbon, i);
    largest = std::max({largest, fold > 0 ? std::abs(gradient[0]) / fold : 0, std::abs(gradient[1])});
  }
  for (int c = 0; c < 6; ++c) {
    if (problem.base_fixed[static_cast<std::size_t>(c)]) continue;
    largest = std::max(largest, std::abs(work.sweep.base_gradient[c]) * (c < 3 ? ribbon.width : 1));
  }
  return largest;
}

}  // namespace wunderlich::solver
