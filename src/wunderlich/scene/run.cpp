#include "wunderlich/scene/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/geometry/topology.hpp"
#include "wunderlich/scene/cursor.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;
using geometry::State;
using solver::PathProblem;
using solver::PathState;
using solver::PathStep;
using solver::Phase;

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxFailures = 200;  // rejected steps in a row, each at half the length

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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
  row.energy.normalized = row.energy.elastic * path.ribbon.length / (path.ribbon.bending_stiffness * path.ribbon.width);
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    row.energy.gravity -= path.ribbon.node_mass[i] * path.surroundings.gravity.dot(shape.r[i]);
  }
  row.constraints = constraint::errors(ribbon, shape);
  row.area_error = geometry::area_error(ribbon, shape);
  row.iterations = step.iterations;
  row.step_us = step_us;
  return row;
}

/// Keeps about `limit` records: when there are too many, every second one goes, but never the first or last.
void thin(std::vector<Record>& records, int limit) {
  const auto most = static_cast<std::size_t>(std::max(2, limit));
  if (records.size() <= most) return;
  std::vector<Record> kept;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i % 2 == 0 || i + 1 == records.size()) kept.push_back(std::move(records[i]));
  }
  records = std::move(kept);
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

void add_phase_time(Timing& timing, const std::string& phase, double seconds) {
  for (auto& [name, sum] : timing.phases) {
    if (name == phase) {
      sum += seconds;
      return;
    }
  }
  timing.phases.emplace_back(phase, seconds);
}

void add_ends(const PathProblem& path, const PathState& state, solver::NewtonWorkspace& work, Summary& summary) {
  if (path.ribbon.is_loop()) return;
  const solver::EndReactions reactions = solver::end_reactions(path, state, work);
  for (std::size_t end = 0; end < 2; ++end) summary.ends.push_back({reactions.force[end], reactions.torque[end]});
}

void add_warnings(const Scene& scene, const State& shape, Summary& summary) {
  if (summary.stability && !summary.stability->stable) {
    summary.warnings.push_back("the equilibrium is unstable: " + std::to_string(summary.stability->negative_modes) +
                               " negative modes");
  }
  const double most_bent = [&] {
    const PathProblem path = path_of(scene);
    const auto strain = geometry::strains(ribbon_of(path, shape), shape);
    double most = 0;
    for (std::size_t i = 0; i < strain.kappa.size(); ++i) {
      most = std::max(most, std::abs(strain.kappa[i]) * path.ribbon.hinge_length[i]);
    }
    return most;
  }();
  if (most_bent > 0.5) {
    summary.warnings.push_back("some hinges turn by more than 0.5 rad; more segments would resolve the curvature");
  }
  if (scene.ribbon.closure == geometry::Closure::loop && std::abs(scene.ribbon.half_twists) >= 2) {
    summary.warnings.push_back("contact is not modelled: a loop with this many half twists may pass through itself");
  }
}

Summary summarise(const Scene& scene, const PathProblem& path, const PathState& state, const Progress& progress,
                  Outcome outcome, solver::NewtonWorkspace& work) {
  const Record& last = progress.records.back();
  const Ribbon& ribbon = solver::ribbon_of(path, state);
  Summary summary;
  summary.scene = scene.name;
  summary.method = "equilibrium";
  summary.converged = outcome == Outcome::converged;
  summary.segments = path.ribbon.segments;
  summary.time = last.state.time;
  summary.steps = state.steps;
  summary.energy = last.history.energy;
  summary.constraints = last.history.constraints;
  summary.area_error = last.history.area_error;
  summary.topology = geometry::topology(ribbon, last.state);
  summary.kappa_zeros = geometry::kappa_zeros(ribbon, geometry::strains(ribbon, last.state).kappa);
  if (path.ribbon.is_loop()) {
    summary.closure_error = (last.state.r.back() - last.state.r.front()).norm() / path.ribbon.length;
  }
  if (summary.converged) summary.stability = Stability{state.negative_modes == 0, state.negative_modes};
  add_ends(path, state, work, summary);
  add_warnings(scene, last.state, summary);
  return summary;
}

/// One run under way.
struct Run {
  const Scene& scene;
  PathProblem path;
  PathState state;
  solver::NewtonWorkspace work;
  Progress progress;
  Timing timing;
  std::vector<double> step_us;
  std::string failure;

  void record(const PathStep& step, double us) {
    State shape = geometry::state_of(solver::ribbon_of(path, state), state.chain, state.clock);
    Record entry;
    entry.history = history_of(path, state, shape, step, us);
    entry.state = std::move(shape);
    progress.records.push_back(std::move(entry));
    thin(progress.records, scene.output.frames);
  }

  Outcome go(const Observer& observer) {
    for (int failures = 0; state.phase != Phase::done;) {
      const Phase phase = state.phase;
      const auto start = Clock::now();
      const PathStep step = solver::advance(path, state, work);
      const double seconds = seconds_since(start);
      timing.wall_seconds += seconds;
      add_phase_time(timing, solver::phase_name(phase), seconds);
      failures = step.accepted ? 0 : failures + 1;
      if (step.accepted && (step.iterations > 0 || phase == Phase::bend)) {
        if (step.iterations > 0) step_us.push_back(1e6 * seconds);  // bending to a ring solves nothing
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

/// A closed band keeps its linking number unless it passes through itself, which nothing here prevents.
std::string lost_turns(const PathProblem& path, const PathState& state, const State& shape) {
  if (!path.ribbon.is_loop() || solver::is_planar(path)) return "";
  const double wanted = 0.5 * path.ribbon.half_twists;
  const double link = geometry::topology(solver::ribbon_of(path, state), shape).link;
  if (std::abs(link - wanted) < 0.1) return "";
  return "the band closed with linking number " + std::to_string(link) + " instead of " + std::to_string(wanted) +
         ": it passed through itself on the way (contact is not modelled)";
}

}  // namespace

RunResult run(const Scene& scene, const Observer& observer, const Progress* resume) {
  Run run{scene, path_of(scene), {}, {}, {}, {}, {}, {}};
  if (resume) {
    run.progress.records = resume->records;
    run.state = unpack_cursor(run.path, resume->cursor);
  } else {
    run.state = solver::start_path(run.path);
    run.record({}, 0);
  }
  RunResult result;
  result.outcome = run.go(observer);
  if (result.outcome == Outcome::converged) {
    run.failure = lost_turns(run.path, run.state, run.progress.records.back().state);
    if (!run.failure.empty()) result.outcome = Outcome::not_converged;
  }
  result.summary = summarise(scene, run.path, run.state, run.progress, result.outcome, run.work);
  result.summary.failure = result.outcome == Outcome::not_converged ? run.failure : "";
  result.summary.timing = run.timing;
  result.summary.timing.step_us_median = percentile(run.step_us, 0.5);
  result.summary.timing.step_us_p95 = percentile(run.step_us, 0.95);
  result.summary.timing.iterations_mean =
      run.state.steps > 0 ? static_cast<double>(run.state.iterations) / run.state.steps : 0;
  run.progress.cursor = pack_cursor(run.state);
  result.progress = std::move(run.progress);
  return result;
}

Frame frame_of(const Scene& scene, const State& state) {
  const PathProblem path = path_of(scene);
  const Ribbon& ribbon = ribbon_of(path, state);
  return {state.time, geometry::centerline(ribbon, state),
          geometry::render_mesh(ribbon, state, scene.output.subdivision, scene.output.across)};
}

FlatPattern pattern_of(const Scene& scene, const State& state) {
  const PathProblem path = path_of(scene);
  return geometry::flat_pattern(ribbon_of(path, state), state);
}

}  // namespace wunderlich::scene
