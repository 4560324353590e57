#include <cmath>

#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/geometry/topology.hpp"
#include "wunderlich/scene/cursor.hpp"
#include "wunderlich/scene/recording.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;
using geometry::State;
using solver::PathProblem;
using solver::PathState;
using solver::PathStep;
using solver::Phase;

namespace {

constexpr int kMaxFailures = 200;  // rejected steps in a row, each at half the length

PathProblem path_of(const Scene& scene) {
  const SolverOptions& s = scene.solver;
  solver::PathOptions options;
  options.model = s.energy;
  options.loop_path = s.loop_path;
  options.duration = s.duration;
  options.steps = s.steps;
  options.tolerance = s.tolerance;
  options.max_iterations = s.max_iterations;
  options.barrier = s.barrier;
  return solver::make_path(geometry::make_ribbon(scene.ribbon), scene.surroundings, options);
}

/// A loop's states before it closes belong to the cut strip.
const Ribbon& ribbon_of(const PathProblem& path, const State& state) {
  if (!path.ribbon.is_loop()) return path.ribbon;
  const Quat seam = geometry::across_seam(path.ribbon, state.q.front());
  const bool closed = (state.r.back() - state.r.front()).norm() < 1e-6 * path.ribbon.length &&
                      seam.angularDistance(state.end_frame[1]) < 1e-6;
  return closed ? path.ribbon : path.cut;
}

HistoryRow history_of(const PathProblem& path, const PathState& state, const State& shape, const PathStep& step,
                      double step_us) {
  const Ribbon& ribbon = solver::ribbon_of(path, state);
  HistoryRow row;
  row.time = shape.time;
  row.energy.elastic = solver::elastic_energy(ribbon, path.options.model, state.chain);
  row.energy.normalized = normalized(ribbon, row.energy.elastic);
  row.energy.gravity = energy::gravity_value(ribbon, path.surroundings.gravity, shape);
  row.constraints = constraint::errors(ribbon, shape);
  row.area_error = geometry::area_error(ribbon, shape);
  row.iterations = step.iterations;
  row.step_us = step_us;
  return row;
}

void add_ends(const PathProblem& path, const PathState& state, solver::NewtonWorkspace& work, Summary& summary) {
  if (path.ribbon.is_loop()) return;
  const solver::EndReactions reactions = solver::end_reactions(path, state, work);
  for (std::size_t end = 0; end < 2; ++end) summary.ends.push_back({reactions.force[end], reactions.torque[end]});
}

Summary summarise(const Scene& scene, const PathProblem& path, const PathState& state, const Record& last,
                  Outcome outcome, solver::NewtonWorkspace& work) {
  Summary summary = summary_of(scene, solver::ribbon_of(path, state), last, outcome);
  summary.method = "equilibrium";
  summary.steps = state.steps;
  if (summary.converged) summary.stability = Stability{state.negative_modes == 0, state.negative_modes};
  if (summary.stability && !summary.stability->stable) {
    summary.warnings.push_back("the equilibrium is unstable: " + std::to_string(summary.stability->negative_modes) +
                               " negative modes");
  }
  add_ends(path, state, work, summary);
  if (summary.converged) summary.imbalance = solver::joint_imbalance(path, state, work);
  if (!path.surroundings.obstacles.empty() || path.surroundings.contact.self) {
    summary.contact = ContactSummary{state.touching, std::max(0.0, -state.nearest), state.nearest};
  }
  return summary;
}

/// One run under way.
struct Run {
  const Scene& scene;
  PathProblem path;
  PathState state;
  solver::NewtonWorkspace work;
  Recording recording;
  std::string failure;

  void record(const PathStep& step, double us) {
    State shape = geometry::state_of(solver::ribbon_of(path, state), state.chain, state.clock);
    Record entry;
    entry.history = history_of(path, state, shape, step, us);
    entry.states.push_back(std::move(shape));
    recording.records.push_back(std::move(entry));
    thin(recording.records, scene.output.frames);
  }

  Outcome go(const Observer& observer) {
    for (int failures = 0; state.phase != Phase::done;) {
      const Phase phase = state.phase;
      const Stopwatch watch;
      const PathStep step = solver::advance(path, state, work);
      const double seconds = watch.seconds();
      recording.timing.wall_seconds += seconds;
      recording.add_phase_time(solver::phase_name(phase), seconds);
      failures = step.accepted ? 0 : failures + 1;
      if (step.accepted && (step.iterations > 0 || phase == Phase::bend)) {
        if (step.iterations > 0) recording.step_us.push_back(1e6 * seconds);  // bending to a ring solves nothing
        record(step, 1e6 * seconds);
      }
      failure = step.failure;
      if (step.exhausted || failures > kMaxFailures) return Outcome::not_converged;
      const RunStatus status{solver::phase_name(phase), solver::fraction_done(path, state), state.iterations};
      if (observer && !observer(status) && state.phase != Phase::done) return Outcome::interrupted;
    }
    return Outcome::converged;
  }
};

}  // namespace

std::string lost_turns(const PathProblem& path, const PathState& state, const State& shape) {
  if (!path.ribbon.is_loop() || solver::is_planar(path)) return "";
  const double wanted = 0.5 * path.ribbon.half_twists;
  const double link = geometry::topology(solver::ribbon_of(path, state), shape).link;
  if (std::abs(link - wanted) < 0.1) return "";
  return "the band closed with linking number " + std::to_string(link) + " instead of " + std::to_string(wanted) +
         ": it passed through itself on the way" +
         (path.surroundings.contact.self ? "" : " (`contact.self: true` keeps it from that)");
}

RunResult run_path(const Scene& scene, const Observer& observer, const Progress* resume) {
  Run run{scene, path_of(scene), {}, {}, {}, {}};
  if (resume) {
    run.recording.records = resume->records;
    run.state = unpack_cursor(run.path, resume->cursor);
  } else {
    run.state = solver::start_path(run.path);
    run.record({}, 0);
  }
  RunResult result;
  result.outcome = run.go(observer);
  const Record& last = run.recording.records.back();
  if (result.outcome == Outcome::converged) {
    run.failure = lost_turns(run.path, run.state, last.states.front());
    if (!run.failure.empty()) result.outcome = Outcome::not_converged;
  }
  result.summary = summarise(scene, run.path, run.state, last, result.outcome, run.work);
  result.summary.failure = result.outcome == Outcome::not_converged ? run.failure : "";
  result.summary.timing = run.recording.finished(run.state.steps, run.state.iterations);
  result.progress = {std::move(run.recording.records), pack_cursor(run.state)};
  return result;
}

Ribbon path_ribbon(const Scene& scene, const State& state) { return ribbon_of(path_of(scene), state); }

}  // namespace wunderlich::scene
