#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "wunderlich/base/error.hpp"
#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/recording.hpp"
#include "wunderlich/scene/start.hpp"
#include "wunderlich/solver/two_stage/two_stage.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;
using geometry::State;
namespace two_stage = solver::two_stage;

namespace {

constexpr int kMaxHalvings = 8;        // of a step that fails
constexpr double kManySubsteps = 100;  // in a step, of which a user should know
constexpr int kRestingSteps = 20;      // below the speed of rest, before a motion is over

/// Which ends of an open strip have a frame of their own: those that a clamp holds at this time.
std::array<bool, 2> clamped_at(const Scene& scene, double time) {
  std::array<bool, 2> clamped{};
  if (scene.ribbon.closure == geometry::Closure::loop) return clamped;
  for (const constraint::Support& support : scene.surroundings.supports) {
    const bool at_end = support.node == 0 || support.node == scene.ribbon.segments;
    const bool clamps = at_end && support.segment < 0 && support.orientation == constraint::Orientation::full;
    if (clamps && holds(support, time)) clamped[support.node == 0 ? 0 : 1] = true;
  }
  return clamped;
}

/// The counters of a run, beside the solver's own state.
struct Counters {
  double step = 0;  ///< of the scene's own steps
  double taken = 0;
  double iterations = 0;
  double resting = 0;
  double substeps = 0;
  double exceeded = 0;  ///< steps beyond the stability bound
};

template <class Counters, class State, class Visit>
void visit_cursor(Counters& counters, State& state, const Visit& visit) {
  for (auto* c : {&counters.step, &counters.taken, &counters.iterations, &counters.resting, &counters.substeps,
                  &counters.exceeded}) {
    visit(*c);
  }
  const auto vectors = [&](auto& list) {
    for (auto& v : list) visit(v[0]), visit(v[1]), visit(v[2]);
  };
  const auto frames = [&](auto& list) {
    for (auto& q : list) visit(q.x()), visit(q.y()), visit(q.z()), visit(q.w());
  };
  visit(state.shape.time);
  vectors(state.shape.r);
  vectors(state.shape.r_dot);
  frames(state.shape.q);
  for (auto& eta : state.shape.eta) visit(eta);
  frames(state.shape.end_frame);
  for (auto& spin : state.spin) visit(spin);
  for (auto& multiplier : state.multipliers) visit(multiplier);
}

/// One run under way.
struct Motion {
  const Scene& scene;
  Ribbon ribbon;  ///< as it is held now
  two_stage::State state;
  two_stage::Workspace work;
  Recording recording;
  Counters counters;
  double stable_step = 0;
  std::string failure;

  long step_count() const {
    return std::max(1L, std::lround(std::ceil(scene.solver.duration / scene.solver.time_step - 1e-9)));
  }
  double time_of(long step) const {
    return step >= step_count() ? scene.solver.duration : static_cast<double>(step) * scene.solver.time_step;
  }

  void record(int iterations, double us) {
    Record entry;
    entry.state = state.shape;
    HistoryRow& row = entry.history;
    row.time = state.shape.time;
    row.energy.elastic = energy::elastic_value(ribbon, scene.solver.energy, state.shape);
    row.energy.kinetic = energy::kinetic_value(ribbon, state.shape);
    row.energy.gravity = energy::gravity_value(ribbon, scene.surroundings.gravity, state.shape);
    row.energy.normalized = normalized(ribbon, row.energy.elastic);
    row.constraints = constraint::errors(ribbon, state.shape);
    row.area_error = geometry::area_error(ribbon, state.shape);
    row.iterations = iterations;
    row.step_us = us;
    recording.records.push_back(std::move(entry));
  }

  /// Clamps that let go at this time leave their end without a frame of its own.
  void release() {
    if (clamped_at(scene, state.shape.time) == ribbon.clamped) return;
    ribbon = motion_ribbon(scene, state.shape.time);
    if (!ribbon.clamped[0]) state.shape.end_frame[0] = state.shape.q.front();
    if (!ribbon.clamped[1]) state.shape.end_frame[1] = state.shape.q.back();
  }

  /// From t0 to t1; a step that fails is tried again in halves.
  bool advance(double t0, double t1, int halvings, int& iterations) {
    const two_stage::Drive drive = drive_between(scene, ribbon, state.shape, t0, t1);
    const two_stage::StepReport report = two_stage::step(ribbon, drive, scene.solver.two_stage, t1 - t0, state, work);
    recording.add_phase_time("ode", report.ode_seconds);
    recording.add_phase_time("opt", report.opt_seconds);
    recording.add_phase_time("other", report.other_seconds);
    stable_step = report.stable_step;
    if (report.accepted) {
      state.shape.time = t1;
      release();
      iterations += report.iterations;
      counters.taken += 1;
      counters.substeps += report.substeps;
      counters.exceeded += report.exceeds_bound ? 1 : 0;
      return true;
    }
    failure = report.failure;
    if (halvings == 0) return false;
    const double middle = 0.5 * (t0 + t1);
    return advance(t0, middle, halvings - 1, iterations) && advance(middle, t1, halvings - 1, iterations);
  }

  /// Up to t1, with a stop wherever a support lets go.
  bool advance_to(double t1, int& iterations) {
    while (state.shape.time < t1) {
      const double t0 = state.shape.time;
      double next = t1;
      for (const constraint::Support& support : scene.surroundings.supports) {
        if (support.release > t0 * (1 + 1e-9) && support.release < next * (1 - 1e-9)) next = support.release;
      }
      if (!advance(t0, next, kMaxHalvings, iterations)) return false;
    }
    return true;
  }

  /// When the last thing that the scene imposes has happened.
  double last_event() const {
    double last = 0;
    for (const constraint::Support& support : scene.surroundings.supports) {
      last = std::max(last, end_time(support.motion));
      if (std::isfinite(support.release)) last = std::max(last, support.release);
    }
    for (const constraint::Load& load : scene.surroundings.loads) last = std::max(last, load.keys.back().time);
    return last;
  }

  /// Slower than a wave of bending would cross 1e-5 of the strip in the time it takes along the strip.
  bool resting() const {
    if (state.shape.time < last_event()) return false;
    double fastest = 0;
    for (const Vec3& v : state.shape.r_dot) fastest = std::max(fastest, v.norm());
    return fastest < 1e-5 * std::sqrt(ribbon.bending_stiffness / ribbon.area_density) / ribbon.length;
  }

  Outcome go(const Observer& observer) {
    const long steps = step_count();
    const long most = std::max(1, scene.output.frames - 1);  // beside the start
    const long stride = std::max(1L, (steps + most - 1) / most);
    while (static_cast<long>(counters.step) < steps) {
      const auto step = static_cast<long>(counters.step) + 1;
      const Stopwatch watch;
      int iterations = 0;
      if (!advance_to(time_of(step), iterations)) return Outcome::not_converged;
      const double us = 1e6 * watch.seconds();
      recording.timing.wall_seconds += 1e-6 * us;
      recording.step_us.push_back(us);
      counters.step = static_cast<double>(step);
      counters.iterations += iterations;
      counters.resting = resting() ? counters.resting + 1 : 0;
      const bool over = step == steps || (scene.solver.stop_at_rest && counters.resting >= kRestingSteps);
      if (over || step % stride == 0) record(iterations, us);
      if (over) return Outcome::converged;
      const RunStatus status{"motion", static_cast<double>(step) / static_cast<double>(steps),
                             static_cast<int>(counters.iterations)};
      if (observer && !observer(status)) return Outcome::interrupted;
    }
    return Outcome::converged;
  }

  std::vector<double> cursor() {
    std::vector<double> out;
    visit_cursor(counters, state, [&](double number) { out.push_back(number); });
    return out;
  }

  void resume(const Progress& progress) {
    recording.records = progress.records;
    state = two_stage::start(ribbon, progress.records.back().state);
    std::size_t size = 0;
    visit_cursor(counters, state, [&](double) { ++size; });
    if (size != progress.cursor.size()) {
      throw InputError("checkpoint: the stored solver state does not fit the stored scene");
    }
    std::size_t next = 0;
    visit_cursor(counters, state, [&](double& number) { number = progress.cursor[next++]; });
    ribbon = motion_ribbon(scene, state.shape.time);
  }
};

std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

void add_warnings(const Motion& motion, Summary& summary) {
  if (motion.counters.exceeded > 0) {
    summary.warnings.push_back("the step of " + text_of(motion.scene.solver.time_step) +
                               " s is beyond the stability bound of " + text_of(motion.stable_step) +
                               " s: what looks like motion may be instability");
  } else if (motion.counters.substeps > kManySubsteps * motion.counters.taken) {
    summary.warnings.push_back("each step was divided into " +
                               text_of(motion.counters.substeps / motion.counters.taken) +
                               " (in the mean): the stability bound is " + text_of(motion.stable_step) + " s");
  }
}

}  // namespace

Ribbon motion_ribbon(const Scene& scene, double time) {
  geometry::RibbonSpec spec = scene.ribbon;
  spec.clamped = clamped_at(scene, time);
  return geometry::make_ribbon(spec);
}

RunResult run_motion(const Scene& scene, const Observer& observer, const Progress* resume) {
  Motion motion{scene, motion_ribbon(scene, 0), {}, {}, {}, {}, 0, {}};
  RunResult result;
  if (resume) {
    motion.resume(*resume);
    result.outcome = motion.go(observer);
  } else {
    Start start = start_of(scene, motion.ribbon);
    motion.failure = start.failure;
    if (!start.failure.empty()) start.shape = geometry::straight_state(motion.ribbon);
    motion.state = two_stage::start(motion.ribbon, start.shape);
    motion.record(0, 0);
    if (motion.failure.empty()) result.outcome = motion.go(observer);
  }
  if (result.outcome == Outcome::not_converged &&
      motion.recording.records.back().state.time < motion.state.shape.time) {
    motion.record(0, 0);  // the last good state
  }
  result.summary = summary_of(scene, motion.ribbon, motion.recording.records.back(), result.outcome);
  result.summary.method = "two-stage";
  result.summary.steps = static_cast<int>(motion.counters.step);
  result.summary.failure = result.outcome == Outcome::not_converged
                               ? motion.failure + " (at " + text_of(motion.state.shape.time) + " s)"
                               : "";
  result.summary.timing =
      motion.recording.finished(static_cast<int>(motion.counters.taken), static_cast<int>(motion.counters.iterations));
  add_warnings(motion, result.summary);
  result.progress = {std::move(motion.recording.records), motion.cursor()};
  return result;
}

}  // namespace wunderlich::scene
