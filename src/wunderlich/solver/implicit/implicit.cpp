#include "wunderlich/solver/implicit/implicit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_ties.hpp"
#include "wunderlich/solver/implicit/balance.hpp"
#include "wunderlich/solver/implicit/beginning.hpp"
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
constexpr int kPatient = 4;          // halvings from which on a minimisation is worth more iterations and shorter ways
constexpr double kProbe = 0.02;      // of the strip's own time: the step that finds accelerations
constexpr double kProbeShare = 0.1;  // of the last step, and of the time that gravity takes for a segment: at most

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

NewtonOptions newton_options(const Options& options, int halvings) {
  NewtonOptions newton;
  newton.tolerance = options.tolerance;
  newton.max_iterations = options.max_iterations;
  if (halvings < kPatient) return newton;
  newton.max_iterations *= 4;
  newton.largest_shift *= 1e6;
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

bool is_held(Paths paths) {
  return std::any_of(paths.begin(), paths.end(), [](const PathProblem& p) { return !p.surroundings.supports.empty(); });
}

/// `held`: supports hold a strip.
std::string why(const NewtonReport& report, double t, double h, bool held) {
  std::string text = "step of " + std::to_string(h) + " s to " + std::to_string(t) + " s: ";
  switch (report.outcome) {
    case NewtonOutcome::iteration_limit:
      return text + "no convergence in " + std::to_string(report.iterations) + " iterations; last step " +
             std::to_string(report.last_step) + ", largest at node " + std::to_string(report.worst_node);
    case NewtonOutcome::line_search_failed:
      return text + "no step lowers the energy, node " + std::to_string(report.worst_node) +
             " moves most; supports may move too fast or ask for more than the strip can reach";
    case NewtonOutcome::singular:
      return text + (held
                         ? "the linear system is singular; supports may hold the same motion twice"
                         : "the linear system is singular or nearly so, though no support holds the strip; contact may "
                           "press it harder than its segments can follow");
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
double probe_step(Paths paths, const State& state) {
  double h = std::numeric_limits<double>::infinity();
  for (const PathProblem& path : paths) {
    const double segment = path.ribbon.length / path.ribbon.segments, g = path.surroundings.gravity.norm();
    h = std::min(h, kProbe * own_time(path.ribbon) / path.ribbon.segments);
    if (g > 0) h = std::min(h, kProbeShare * std::sqrt(segment / g));
  }
  if (state.last_step > 0) h = std::min(h, kProbeShare * state.last_step);
  return h;
}

/// A strip that may float where it likes: how far it floats in a step is a linear equation, which Newton's last step
/// solves at the iterate before. Solved here at the last one, so that linear momentum is kept to rounding.
void float_freely(const Ribbon& ribbon, const ChainProblem& problem, Chain& chain, geometry::Kinematics& k) {
  if (!problem.holds.empty() || !problem.loads.empty() || !problem.grips.empty() || !problem.contact.empty()) return;
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

StripState start_strip(const PathProblem& path, const Options& options, const geometry::State& shape, const Vec3& spin,
                       StripWorkspace& work) {
  StripState state;
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
  return state;
}

double kinetic_energy(Paths paths, const Options& options, const State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const StripState& strip = state.strips[i];
    sum += kinetic_energy(paths[i].ribbon, options.kinetic, strip.points, strip.path.chain.eta);
  }
  return sum;
}

/// Of the strips as they lie, barriers and contact included.
double elastic_now(Paths paths, const State& state, Workspace& work) {
  find_contacts(paths, state, work);
  double sum = work.self.active() ? self_energy(work.self, work.self_before) : 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const StripWorkspace& own = work.strips[i];
    const Chain& chain = state.strips[i].path.chain;
    const ObjectiveValue now = objective(paths[i].ribbon, own.problem, chain, own.kinematics, own.kinematics);
    sum += now.elastic + now.barrier;
    if (!own.solids.empty()) sum += contact_energy(paths[i].ribbon, own.solids, own.before);
  }
  return sum;
}

}  // namespace

State start(Paths paths, const Options& options, std::span<const geometry::State> shapes, std::span<const Vec3> spins,
            Workspace& work) {
  State state;
  work.strips.resize(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    state.strips.push_back(start_strip(paths[i], options, shapes[i], spins[i], work.strips[i]));
  }
  state.peak = kinetic_energy(paths, options, state);
  find_accelerations(paths, options, state, work);
  return state;
}

void find_accelerations(Paths paths, const Options& options, State& state, Workspace& work) {
  // A short Euler step that is thrown away.
  work.strips.resize(paths.size());
  const double h = probe_step(paths, state);
  const Scheme scheme = make_scheme(Integrator::euler, 0, h, 0);
  for (std::size_t i = 0; i < paths.size(); ++i) work.strips[i].trial = state.strips[i].path.chain;
  set_problems(paths, options, scheme, state.time() + h, state, work);
  for (StripWorkspace& own : work.strips) own.problem.viscosity = 0;
  // The hinge of a clamp that has let go took its energy along.
  state.elastic = elastic_now(paths, state, work);
  state.last_step = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripState& strip = state.strips[i];
    strip.momentum = momentum(paths[i].ribbon, options.kinetic, strip.points, strip.path.chain.eta);
    strip.base_reaction.setZero();
    strip.path.multipliers.clear();
    std::fill(strip.points.a.begin(), strip.points.a.end(), Vec3::Zero());
    strip.points.acceleration = strip.points.a;
    work.strips[i].multipliers.assign(row_count(work.strips[i].problem), 0.0);
  }
  NewtonOptions newton = newton_options(options, 0);
  newton.tolerance = 1e-10;
  const NewtonReport report = minimise(moving(paths, work), work.self, newton, work.newton);
  if (!report.converged()) return;  // from rest, then
  for (std::size_t k = 0; k < paths.size(); ++k) {
    StripState& strip = state.strips[k];
    StripWorkspace& own = work.strips[k];
    read_points(paths[k].ribbon, options.kinetic, work.newton.strips[k].kinematics, own.x);
    for (std::size_t i = 0; i < own.x.size(); ++i) {
      strip.points.acceleration[i] = scheme.stiffness * (own.x[i] - anchor(scheme, strip.points, i));
      strip.points.a[i] = strip.points.acceleration[i];
    }
    strip.path.multipliers = own.multipliers;
    strip.base_reaction = work.newton.strips[k].sweep.base_gradient;
  }
}

void change_supports(const PathProblem& before, const PathProblem& after, StripState& state) {
  const auto convert = [&](Chain& chain) {
    chain = geometry::chain_of(after.ribbon, geometry::state_of(before.ribbon, chain, 0));
    if (after.ribbon.is_loop()) chain.eta.back() = after.ribbon.seam_sign() * chain.eta.front();
  };
  convert(state.path.chain);
  state.before = state.path.chain;
  note_frames(after, state.path);
}

namespace {

/// Positions and velocities at the end of a step that has converged: the largest local error over the length, and the
/// kinetic energy.
struct End {
  double error = 0, kinetic = 0;
};

End finish_strips(Paths paths, const Options& options, const Scheme& scheme, const State& state, Workspace& work) {
  End end;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Ribbon& ribbon = paths[i].ribbon;
    const StripState& strip = state.strips[i];
    StripWorkspace& own = work.strips[i];
    geometry::Kinematics& k = work.newton.strips[i].kinematics;
    if (!work.self.active()) float_freely(ribbon, own.problem, own.trial, k);
    read_points(ribbon, options.kinetic, k, own.x);
    own.points = strip.points;
    end.error = std::max(end.error, finish(scheme, own.x, own.points) / ribbon.length);
    end.kinetic += kinetic_energy(ribbon, options.kinetic, own.points, strip.path.chain.eta);
  }
  return end;
}

/// The end of the step becomes the state.
void move_on(Paths paths, const Options& options, double t1, const StepReport& report, State& state, Workspace& work) {
  const double h = t1 - state.time();
  state.last_step = h;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripState& strip = state.strips[i];
    StripWorkspace& own = work.strips[i];
    strip.before = strip.path.chain;
    std::swap(strip.path.chain, own.trial);
    std::swap(strip.path.multipliers, own.multipliers);
    std::swap(strip.points, own.points);
    strip.base_reaction = work.newton.strips[i].sweep.base_gradient;
    strip.path.t = t1;
    ++strip.path.steps;
    strip.path.iterations += report.iterations;
    if (carries_frames(paths[i])) note_frames(paths[i], strip.path);
    drag(paths[i].ribbon, options, h, work.newton.strips[i].kinematics, strip.points);
  }
}

/// Smallest distances at the end of the step, and how much is felt.
void report_contact(const Workspace& work, StepReport& report) {
  for (std::size_t i = 0; i < work.strips.size(); ++i) {
    const ContactPoints& points = work.newton.strips[i].touching.points;
    report.nearest = std::min(report.nearest, smallest_distance(work.strips[i].problem.contact, points));
    report.touching += contact_count(points);
  }
  if (!work.self.active()) return;
  report.nearest = std::min(report.nearest, smallest_distance(work.self, work.newton.self));
  report.touching += static_cast<int>(work.newton.self.pairs.size());
}

}  // namespace

StepReport step(Paths paths, const Options& options, double t1, int halvings, State& state, Workspace& work) {
  work.strips.resize(paths.size());
  const double h = t1 - state.time();
  StepReport report;
  const int level = state.level;
  const double kinetic0 = kinetic_energy(paths, options, state);
  double own_energies = 0;
  for (const PathProblem& path : paths) own_energies += own_energy(path.ribbon);
  bool loaded = false;  // without a potential, or by a hand, whose work is not asked for
  double growth = 0;    // of the energy, beyond the work of loads and supports
  const auto fail = [&](const std::string& failure) {
    state.level = level;
    report.failure = failure;
    return report;
  };
  for (;; state.level = damp_more(options, state.level), ++report.repeats) {
    const Scheme scheme = scheme_of(options, state, h);
    prepare(paths, options, scheme, t1, state, work);
    if (!start_clear(paths, state, h, work)) {
      return fail("something runs into the strip within a step of " + std::to_string(h) + " s");
    }
    report.newton = minimise(moving(paths, work), work.self, newton_options(options, halvings), work.newton);
    report.iterations += report.newton.iterations;
    if (!report.newton.converged()) return fail(why(report.newton, t1, h, is_held(paths)));
    const End end = finish_strips(paths, options, scheme, state, work);
    report.error = end.error;
    const double elastic1 = report.newton.value.elastic + report.newton.value.barrier + report.newton.value.contact;
    growth = elastic1 - state.elastic + end.kinetic - kinetic0 - work_done(paths, scheme, state, work);
    const double peak = std::max(state.peak, end.kinetic);
    loaded = std::any_of(work.strips.begin(), work.strips.end(), [](const StripWorkspace& own) {
      return !own.problem.loads.empty() || !own.problem.grips.empty();
    });
    const bool grows = !loaded && !(growth <= kGrowth * peak + kLeastGrowth * own_energies);
    if (grows && can_damp(options, state, halvings)) continue;
    if (grows) {
      return fail("the energy grows by " + std::to_string(growth / peak) +
                  " of the largest kinetic energy in a step of " + std::to_string(h) + " s");
    }
    // What an impulse changes at once is no error of the step's length.
    if (options.error > 0 && report.error > options.error && state.level != kInelastic) {
      return fail("local error " + std::to_string(report.error));
    }
    state.peak = peak;
    state.elastic = elastic1;
    break;
  }
  // The work of loads without a potential is not known, and what friction takes is gone.
  const bool rubs = !work.strips.front().problem.contact.friction.empty() || !work.self.rubs.empty();
  const bool known = paths.size() == 1 && !loaded && !rubs;
  if (options.conserve && known) keep_conserved(paths.front().ribbon, options, growth, state, work);
  state.calm = report.repeats > 0 ? 0 : std::min(state.calm, kCalmSteps) + 1;
  if (state.calm > kCalmSteps && state.level > 0) --state.level, state.calm = 0;
  move_on(paths, options, t1, report, state, work);
  report_contact(work, report);
  report.inelastic = state.level == kInelastic;
  if (report.inelastic) {  // the accelerations of an impulse are nothing to go on with
    state.level = level;
    find_accelerations(paths, options, state, work);
  }
  report.accepted = true;
  return report;
}

geometry::State shape_of(const PathProblem& path, const StripState& strip) {
  geometry::State shape = geometry::state_of(path.ribbon, strip.path.chain, strip.path.t);
  for (std::size_t i = 0; i < shape.r.size(); ++i) shape.r_dot[i] = strip.points.v[i];
  return shape;
}

}  // namespace wunderlich::solver::implicit
