#include "wunderlich/solver/implicit/implicit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_ties.hpp"
#include "wunderlich/solver/implicit/balance.hpp"
#include "wunderlich/solver/load_step.hpp"
#include "wunderlich/solver/path_step.hpp"

namespace wunderlich::solver::implicit {

using geometry::Chain;
using geometry::Ribbon;

namespace {

constexpr std::array<double, kDampingLevels> kRho{0.9, 0.6, 0.3,
                                                  0};  // what generalised-alpha leaves of the fastest oscillation
constexpr double kGrowth = 1e-3;       // of the energy in one step, over the largest kinetic energy: more is no motion
constexpr double kLeastGrowth = 1e-9;  // the same over D w / l
constexpr int kCalmSteps = 50;         // before less damping is tried again
constexpr int kInelastic = kDampingLevels;  // beyond those: Euler's
constexpr int kShortened = 2;               // halvings of a step that may be inelastic
constexpr double kProbe = 0.02;             // of the strip's own time: the step that finds accelerations
constexpr double kProbeShare = 0.1;  // of the last step, and of the time that gravity takes for a segment: at most
constexpr double kFlat = 1e-4;       // curvature over 1/length that counts as none
constexpr double kBoundaryFraction = 0.5;  // how far the prediction may move |x| towards 1

/// Time in which a wave of bending crosses the strip.
double own_time(const Ribbon& ribbon) {
  return ribbon.length * ribbon.length * std::sqrt(ribbon.area_density / ribbon.bending_stiffness);
}

double own_energy(const Ribbon& ribbon) { return ribbon.bending_stiffness * ribbon.width / ribbon.length; }

bool carries_frames(const PathProblem& path) {
  const auto& supports = path.surroundings.supports;
  return std::any_of(supports.begin(), supports.end(), [](const constraint::Support& support) {
    return support.orientation == constraint::Orientation::about_tangent;
  });
}

Scheme scheme_of(const Options& options, const State& state, double h) {
  if (state.level == kInelastic) return make_scheme(Integrator::euler, 0, h, 0);
  return make_scheme(options.integrator, kRho[static_cast<std::size_t>(state.level)], h, state.last_step);
}

/// Joint coordinates carried on as in the last step; less far where rulings would meet.
void predict(const Ribbon& ribbon, const State& state, double h, Chain& chain) {
  chain = state.path.chain;
  if (state.last_step == 0) return;
  const Chain& now = state.path.chain;
  double share = h / state.last_step;
  for (std::size_t s = 0; s + 1 < now.eta.size(); ++s) {
    const double k = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = k * (now.eta[s + 1] - now.eta[s]);
    const double dx = x - k * (state.before.eta[s + 1] - state.before.eta[s]);
    const double room = kBoundaryFraction * (dx > 0 ? 1 - x : 1 + x);
    if (share * std::abs(dx) > room) share = room / std::abs(dx);
  }
  for (std::size_t i = 0; i < now.kappa.size(); ++i) {
    chain.kappa[i] += share * (now.kappa[i] - state.before.kappa[i]);
    chain.eta[i] += share * (now.eta[i] - state.before.eta[i]);
  }
  const Vec3 turn = math::log_map(now.base.frame * state.before.base.frame.conjugate());
  chain.base.position += share * (now.base.position - state.before.base.position);
  chain.base.frame = math::exp_map(share * turn) * now.base.frame;
}

/// What is held of the base is where it is held.
void keep_held(const ChainProblem& problem, const Pose& held, Pose& base) {
  for (int c = 0; c < 3; ++c) {
    if (problem.base_fixed[static_cast<std::size_t>(c)]) base.position[c] = held.position[c];
  }
  if (problem.base_fixed[3]) base.frame = held.frame;
}

/// Where Newton's method may start: the prediction if nothing is in its way, or else where the strip is, or where a
/// moving solid would carry it. False if something is in the way of all these. Says what rubs as well.
bool start_clear(const PathProblem& path, const State& state, double h, Workspace& work) {
  const Ribbon& ribbon = path.ribbon;
  ContactProblem& contact = work.problem.contact;
  if (work.problem.touchable().empty()) return true;
  place_solids(ribbon, path.surroundings, state.path.t, work.solids);
  geometry::forward_kinematics(ribbon, state.path.chain, work.kinematics);
  const Touchable touchable{work.solids, work.problem.self};
  find_touching(ribbon, touchable, state.path.chain, work.kinematics, work.newton.search, work.before);
  set_friction(ribbon, work.solids, work.before.points, state.path.chain, work.kinematics, h, contact);
  const auto is_clear = [&](const Chain& chain) {
    geometry::forward_kinematics(ribbon, chain, work.newton.kinematics);
    NewtonWorkspace& newton = work.newton;
    return newton.placed = go_touching(ribbon, work.problem.touchable(), work.before, chain, newton.kinematics,
                                       newton.search, newton.touching);
  };
  if (is_clear(work.trial)) return true;
  const Pose held = work.trial.base;
  work.trial = state.path.chain;
  keep_held(work.problem, held, work.trial.base);
  if (is_clear(work.trial)) return true;
  for (std::size_t i = 0; i < contact.solids.size(); ++i) {
    const Pose &from = work.solids.solids[i].pose, &to = contact.solids[i].pose;
    const Quat turn = to.frame * from.frame.conjugate();
    work.trial.base.position = to.position + turn * (state.path.chain.base.position - from.position);
    work.trial.base.frame = turn * state.path.chain.base.frame;
    keep_held(work.problem, held, work.trial.base);
    if (is_clear(work.trial)) return true;
  }
  return false;
}

/// Supports, loads and inertia of a step that ends at t1; `chain` gets its prescribed base.
void set_problem(const PathProblem& path, const Options& options, const Scheme& scheme, double t1, const State& state,
                 Chain& chain, ChainProblem& problem) {
  problem_at(path, state.path, t1, chain, problem);
  problem.barrier = options.barrier;
  if (path.surroundings.supports.empty()) problem.base_fixed.fill(false);
  tie(path.ribbon, options.kinetic, scheme, state.points, state.path.chain.eta, problem);
  problem.viscosity = options.viscosity / scheme.h;
  problem.before = options.viscosity > 0 ? &state.path.chain : nullptr;
}

NewtonOptions newton_options(const Options& options) {
  NewtonOptions newton;
  newton.inertial = true;
  newton.tolerance = options.tolerance;
  newton.max_iterations = options.max_iterations;
  return newton;
}

/// The velocity that is left after drag has acted for a while.
void drag(const Ribbon& ribbon, const Options& options, double h, const geometry::Kinematics& k, Points& points) {
  if (options.drag_tangent == 0 && options.drag_normal == 0) return;
  const double along = std::exp(-options.drag_tangent * h), across = std::exp(-options.drag_normal * h);
  const auto n = static_cast<std::size_t>(ribbon.segments);
  const auto damp = [&](Vec3& v, const Vec3& tangent) {
    const Vec3 part = tangent.dot(v) * tangent;
    v = along * part + across * (v - part);
  };
  for (std::size_t i = 0; i <= n; ++i) {  // the two nodes of a loop's seam are one
    const std::size_t before = i > 0 ? i - 1 : ribbon.is_loop() ? n - 1 : 0;
    const std::size_t after = i < n ? i : ribbon.is_loop() ? 0 : n - 1;
    const Vec3 tangent = (k.frame[before].col(2) + k.frame[after].col(2)).normalized();
    damp(points.v[i], tangent);
    damp(points.v_before[i], tangent);  // BDF2 goes on from both
  }
  for (std::size_t i = n + 1; i < points.v.size(); ++i) {
    points.v[i] *= across;
    points.v_before[i] *= across;
  }
}

std::string why(const NewtonReport& report, double t, double h) {
  std::string text = "step of " + std::to_string(h) + " s to " + std::to_string(t) + " s: ";
  switch (report.outcome) {
    case NewtonOutcome::iteration_limit:
      return text + "no convergence in " + std::to_string(report.iterations) + " iterations; last step " +
             std::to_string(report.last_step) + ", largest at node " + std::to_string(report.worst_node);
    case NewtonOutcome::line_search_failed:
      return text + "no step lowers the energy, node " + std::to_string(report.worst_node) +
             " moves most; supports may move too fast or ask for more than the strip can reach";
    case NewtonOutcome::singular:
      return text + "the linear system is singular; supports may hold the same motion twice";
    case NewtonOutcome::converged:
      break;
  }
  return text + "energy grows";
}

int damp_more(const Options& options, int level) {
  return options.integrator == Integrator::generalised_alpha ? level + 1 : kInelastic;
}

/// Is there more damping to offer? At last Euler's: its velocity is that of the step, so that it takes up an impulse
/// without a rebound, which the others exaggerate at any step length. First, shorter steps must have been no help.
bool can_damp(const Options& options, const State& state, int halvings) {
  if (options.integrator == Integrator::euler || state.level == kInelastic) return false;
  return damp_more(options, state.level) < kInelastic || halvings >= kShortened;
}

/// Length of a step that finds accelerations: short against the strip's own time, long against rounding.
double probe_step(const PathProblem& path, const State& state) {
  const double segment = path.ribbon.length / path.ribbon.segments, g = path.surroundings.gravity.norm();
  double h = kProbe * own_time(path.ribbon) / path.ribbon.segments;
  if (g > 0) h = std::min(h, kProbeShare * std::sqrt(segment / g));
  if (state.last_step > 0) h = std::min(h, kProbeShare * state.last_step);
  return h;
}

/// A strip that may float where it likes: how far it floats in a step is a linear equation, which Newton's last step
/// solves at the iterate before. Solved here at the last one, so that linear momentum is kept to rounding.
void float_freely(const Ribbon& ribbon, const ChainProblem& problem, Chain& chain, geometry::Kinematics& k) {
  if (!problem.holds.empty() || !problem.loads.empty() || !problem.contact.empty()) return;
  Vec3 force = Vec3::Zero();
  double stiffness = 0;
  for (std::size_t i = 0; i < problem.tie.size(); ++i) {
    force += problem.force[i] - problem.tie[i] * (k.r[i] - problem.anchor[i]);
    stiffness += problem.tie[i];
  }
  for (std::size_t s = 0; s < problem.facets.size(); ++s) {
    const FacetTie& facet = problem.facets[s];
    force -= (facet_of(ribbon, k, s) - facet.anchor) * facet.weight.col(0);
    stiffness += facet.weight(0, 0);
  }
  for (int c = 0; c < 3; ++c) {
    if (problem.base_fixed[static_cast<std::size_t>(c)]) continue;
    chain.base.position[c] += force[c] / stiffness;
    for (Vec3& r : k.r) r[c] += force[c] / stiffness;
  }
}

}  // namespace

State start(const PathProblem& path, const Options& options, const geometry::State& shape, const Vec3& spin,
            Workspace& work) {
  State state;
  state.path.phase = Phase::load;
  state.path.closed = path.ribbon.is_loop();
  state.path.t = shape.time;
  state.path.chain = geometry::chain_of(path.ribbon, shape);
  if (path.ribbon.is_loop()) state.path.chain.eta.back() = path.ribbon.seam_sign() * state.path.chain.eta.front();
  state.before = state.path.chain;
  note_frames(path, state.path);
  resize(point_count(path.ribbon, options.kinetic), state.points);
  geometry::forward_kinematics(path.ribbon, state.path.chain, work.kinematics);
  read_points(path.ribbon, options.kinetic, work.kinematics, state.points.x);
  const auto n = static_cast<std::size_t>(path.ribbon.segments);
  for (std::size_t i = 0; i <= n; ++i) state.points.v[i] = shape.r_dot[i];
  for (std::size_t i = n + 1; i < state.points.v.size(); ++i) state.points.v[i] = spin.cross(state.points.x[i]);
  work.problem = ChainProblem();
  problem_at(path, state.path, shape.time, state.path.chain, work.problem);  // its base where the support has it
  state.peak = kinetic_energy(path.ribbon, options.kinetic, state.points, state.path.chain.eta);
  find_accelerations(path, options, state, work);
  return state;
}

void find_accelerations(const PathProblem& path, const Options& options, State& state, Workspace& work) {
  // A short Euler step that is thrown away.
  const double h = probe_step(path, state);
  const Scheme scheme = make_scheme(Integrator::euler, 0, h, 0);
  work.trial = state.path.chain;
  set_problem(path, options, scheme, state.path.t + h, state, work.trial, work.problem);
  work.problem.viscosity = 0;
  // The hinge of a clamp that has let go took its energy along.
  geometry::forward_kinematics(path.ribbon, state.path.chain, work.kinematics);
  const ObjectiveValue now = objective(path.ribbon, work.problem, state.path.chain, work.kinematics, work.kinematics);
  state.elastic = now.elastic + now.barrier;
  place_solids(path.ribbon, path.surroundings, state.path.t, work.solids);
  const Touchable touchable{work.solids, work.problem.self};
  find_touching(path.ribbon, touchable, state.path.chain, work.kinematics, work.newton.search, work.before);
  state.elastic += touching_energy(path.ribbon, touchable, work.before);
  state.momentum = momentum(path.ribbon, options.kinetic, state.points, state.path.chain.eta);
  state.base_reaction.setZero();
  work.multipliers.assign(row_count(work.problem), 0.0);
  NewtonOptions newton = newton_options(options);
  newton.tolerance = 1e-10;
  state.last_step = 0;
  state.path.multipliers.clear();
  std::fill(state.points.a.begin(), state.points.a.end(), Vec3::Zero());
  state.points.acceleration = state.points.a;
  const NewtonReport report = minimise(path.ribbon, work.problem, newton, work.trial, work.multipliers, work.newton);
  if (!report.converged()) return;  // from rest, then
  read_points(path.ribbon, options.kinetic, work.newton.kinematics, work.x);
  for (std::size_t i = 0; i < work.x.size(); ++i) {
    state.points.acceleration[i] = scheme.stiffness * (work.x[i] - anchor(scheme, state.points, i));
    state.points.a[i] = state.points.acceleration[i];
  }
  state.path.multipliers = work.multipliers;
  state.base_reaction = work.newton.sweep.base_gradient;
}

void change_supports(const PathProblem& before, const PathProblem& after, State& state) {
  const auto convert = [&](Chain& chain) {
    chain = geometry::chain_of(after.ribbon, geometry::state_of(before.ribbon, chain, 0));
    if (after.ribbon.is_loop()) chain.eta.back() = after.ribbon.seam_sign() * chain.eta.front();
  };
  convert(state.path.chain);
  state.before = state.path.chain;
  note_frames(after, state.path);
}

namespace {

/// The problem of a step, and the prediction that Newton's method starts from.
void prepare(const PathProblem& path, const Options& options, const Scheme& scheme, double t1, const State& state,
             Workspace& work) {
  const Ribbon& ribbon = path.ribbon;
  predict(ribbon, state, scheme.h, work.trial);
  // Between two held places a flat strip has no direction to go in: Newton's method starts beside it.
  if (path.surroundings.supports.size() > 1 && is_flat(work.trial, ribbon.length, kFlat)) seed(ribbon, work.trial);
  set_problem(path, options, scheme, t1, state, work.trial, work.problem);
  work.multipliers = state.path.multipliers;
  work.multipliers.resize(row_count(work.problem), 0.0);
  // How far the supports have moved: the rows' residuals before the step.
  work.start = state.path.chain;
  work.start.base = work.trial.base;
  if (!work.multipliers.empty()) geometry::forward_kinematics(ribbon, state.path.chain, work.kinematics);
  constraint_residuals(ribbon, work.problem, state.path.chain, work.kinematics, work.residuals);
}

}  // namespace

StepReport step(const PathProblem& path, const Options& options, double t1, int halvings, State& state,
                Workspace& work) {
  const Ribbon& ribbon = path.ribbon;
  const double h = t1 - state.path.t;
  StepReport report;
  const int level = state.level;
  const double kinetic0 = kinetic_energy(ribbon, options.kinetic, state.points, state.path.chain.eta);
  double growth = 0;  // of the energy, beyond the work of loads and supports
  for (;; state.level = damp_more(options, state.level), ++report.repeats) {
    const Scheme scheme = scheme_of(options, state, h);
    prepare(path, options, scheme, t1, state, work);
    if (!start_clear(path, state, h, work)) {
      state.level = level;
      report.failure = "a solid runs into the strip within a step of " + std::to_string(h) + " s";
      return report;
    }
    report.newton = minimise(ribbon, work.problem, newton_options(options), work.trial, work.multipliers, work.newton);
    report.iterations += report.newton.iterations;
    if (!report.newton.converged()) {
      state.level = level;
      report.failure = why(report.newton, t1, h);
      return report;
    }
    float_freely(ribbon, work.problem, work.trial, work.newton.kinematics);
    read_points(ribbon, options.kinetic, work.newton.kinematics, work.x);
    work.points = state.points;
    report.error = finish(scheme, work.x, work.points) / ribbon.length;
    const double kinetic1 = kinetic_energy(ribbon, options.kinetic, work.points, state.path.chain.eta);
    const double elastic1 = report.newton.value.elastic + report.newton.value.barrier + report.newton.value.contact;
    growth = elastic1 - state.elastic + kinetic1 - kinetic0 - work_done(ribbon, scheme, state, work);
    const double peak = std::max(state.peak, kinetic1);
    const bool grows = work.problem.loads.empty() && !(growth <= kGrowth * peak + kLeastGrowth * own_energy(ribbon));
    if (grows && can_damp(options, state, halvings)) continue;
    // What an impulse changes at once is no error of the step's length.
    const bool coarse = options.error > 0 && report.error > options.error && state.level != kInelastic;
    if (grows || coarse) {
      state.level = level;
      report.failure = grows ? "the energy grows by " + std::to_string(growth / peak) +
                                   " of the largest kinetic energy in a step of " + std::to_string(h) + " s"
                             : "local error " + std::to_string(report.error);
      return report;
    }
    state.peak = peak;
    state.elastic = elastic1;
    break;
  }
  // The work of loads without a potential is not known, and what friction takes is gone.
  const bool known = work.problem.loads.empty() && work.problem.contact.friction.empty();
  if (options.conserve && known) keep_conserved(ribbon, options, growth, state, work);
  state.calm = report.repeats > 0 ? 0 : std::min(state.calm, kCalmSteps) + 1;
  if (state.calm > kCalmSteps && state.level > 0) --state.level, state.calm = 0;
  state.before = state.path.chain;
  state.last_step = h;
  std::swap(state.path.chain, work.trial);
  std::swap(state.path.multipliers, work.multipliers);
  std::swap(state.points, work.points);
  state.base_reaction = work.newton.sweep.base_gradient;
  state.path.t = t1;
  ++state.path.steps;
  state.path.iterations += report.iterations;
  if (carries_frames(path)) note_frames(path, state.path);
  drag(ribbon, options, h, work.newton.kinematics, state.points);
  report.nearest = std::min(report.nearest, smallest_distance(work.problem.touchable(), work.newton.touching));
  report.touching = contact_count(work.problem.touchable(), work.newton.touching);
  report.inelastic = state.level == kInelastic;
  if (report.inelastic) {  // the accelerations of an impulse are nothing to go on with
    state.level = level;
    find_accelerations(path, options, state, work);
  }
  report.accepted = true;
  return report;
}

geometry::State shape_of(const PathProblem& path, const State& state) {
  geometry::State shape = geometry::state_of(path.ribbon, state.path.chain, state.path.t);
  for (std::size_t i = 0; i < shape.r.size(); ++i) shape.r_dot[i] = state.points.v[i];
  return shape;
}

}  // namespace wunderlich::solver::implicit
