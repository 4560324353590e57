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
#include "wunderlich/scene/mover.hpp"
#include "wunderlich/scene/start.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;
namespace {

constexpr int kMaxHalvings = 8;    // of a step that fails
constexpr int kRestingSteps = 20;  // below the speed of rest, before a motion is over

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

std::unique_ptr<Mover> mover_of(const Scene& scene) {
  return scene.solver.method == Method::two_stage ? two_stage_mover(scene) : implicit_mover(scene);
}

/// One run under way.
struct Motion {
  explicit Motion(const Scene& s) : scene(s), mover(mover_of(s)) {}

  const Scene& scene;
  std::unique_ptr<Mover> mover;
  Recording recording;
  long step = 0;  ///< of the scene's own steps
  long taken = 0;
  long iterations = 0;
  long resting = 0;
  std::string failure;

  long step_count() const {
    return std::max(1L, std::lround(std::ceil(scene.solver.duration / scene.solver.time_step - 1e-9)));
  }
  double time_of(long number) const {
    return number >= step_count() ? scene.solver.duration : static_cast<double>(number) * scene.solver.time_step;
  }

  double time() const { return mover->shapes().front().time; }

  void record(int used, double us) {
    Record entry;
    entry.states = mover->shapes();
    HistoryRow& row = entry.history;
    row.time = time();
    row.energy.kinetic = mover->kinetic_energy();
    for (std::size_t i = 0; i < entry.states.size(); ++i) add_strip(mover->ribbon(i), entry.states[i], row);
    row.iterations = used;
    row.step_us = us;
    recording.records.push_back(std::move(entry));
  }

  /// Adds energies, keeps the largest errors.
  void add_strip(const Ribbon& ribbon, const geometry::State& shape, HistoryRow& row) const {
    const double elastic = energy::elastic_value(ribbon, scene.solver.energy, shape);
    row.energy.elastic += elastic;
    row.energy.gravity += energy::gravity_value(ribbon, scene.surroundings.gravity, shape);
    row.energy.normalized += normalized(ribbon, elastic);
    const ConstraintErrors errors = constraint::errors(ribbon, shape);
    ConstraintErrors& most = row.constraints;
    for (double ConstraintErrors::*error :
         {&ConstraintErrors::max_length_error, &ConstraintErrors::max_parallel_error, &ConstraintErrors::max_binormal,
          &ConstraintErrors::max_torsion_mismatch, &ConstraintErrors::max_ruling_ratio}) {
      most.*error = std::max(most.*error, errors.*error);
    }
    row.area_error = std::max(row.area_error, geometry::area_error(ribbon, shape));
  }

  /// From t0 to t1; a step that fails is tried again in halves.
  bool advance(double t0, double t1, int halvings, int& used) {
    const Move move = mover->step(t0, t1, halvings, recording);
    used += move.iterations;
    if (move.accepted) {
      ++taken;
      return true;
    }
    failure = move.failure;
    if (halvings == kMaxHalvings) return false;
    const double middle = 0.5 * (t0 + t1);
    return advance(t0, middle, halvings + 1, used) && advance(middle, t1, halvings + 1, used);
  }

  /// Every support of every strip.
  template <class Visit>
  void visit_supports(const Visit& visit) const {
    for (const Scene* strip : strips_of(scene)) {
      for (const constraint::Support& support : strip->surroundings.supports) visit(support);
    }
  }

  /// Up to t1, with a stop wherever a support lets go.
  bool advance_to(double t1, int& used) {
    while (time() < t1) {
      const double t0 = time();
      double next = t1;
      visit_supports([&](const constraint::Support& support) {
        if (support.release > t0 * (1 + 1e-9) && support.release < next * (1 - 1e-9)) next = support.release;
      });
      if (!advance(t0, next, 0, used)) return false;
      if (released(t0, next)) mover->release();
    }
    return true;
  }

  /// Has a support let go?
  bool released(double t0, double t1) const {
    bool any = false;
    visit_supports([&](const constraint::Support& s) { any = any || (holds(s, t0) && !holds(s, t1)); });
    return any;
  }

  /// When the last thing that the scene imposes has happened.
  double last_event() const {
    double last = 0;
    visit_supports([&](const constraint::Support& support) {
      last = std::max(last, end_time(support.motion));
      if (std::isfinite(support.release)) last = std::max(last, support.release);
    });
    for (const Scene* strip : strips_of(scene)) {
      for (const constraint::Load& load : strip->surroundings.loads) last = std::max(last, load.keys.back().time);
    }
    return last;
  }

  /// Slower than a wave of bending would cross 1e-5 of the strip in the time it takes along the strip.
  bool is_resting() const {
    if (time() < last_event()) return false;
    for (std::size_t i = 0; i < mover->shapes().size(); ++i) {
      const Ribbon& ribbon = mover->ribbon(i);
      const double slow = 1e-5 * std::sqrt(ribbon.bending_stiffness / ribbon.area_density) / ribbon.length;
      for (const Vec3& v : mover->shapes()[i].r_dot) {
        if (!(v.norm() < slow)) return false;
      }
    }
    return true;
  }

  Outcome go(const Observer& observer) {
    const long steps = step_count();
    const long most = std::max(1, scene.output.frames - 1);  // beside the start
    const long stride = std::max(1L, (steps + most - 1) / most);
    while (step < steps) {
      const Stopwatch watch;
      int used = 0;
      if (!advance_to(time_of(step + 1), used)) return Outcome::not_converged;
      ++step;
      const double us = 1e6 * watch.seconds();
      recording.timing.wall_seconds += 1e-6 * us;
      recording.step_us.push_back(us);
      iterations += used;
      resting = is_resting() ? resting + 1 : 0;
      const bool over = step == steps || (scene.solver.stop_at_rest && resting >= kRestingSteps);
      if (over || step % stride == 0) record(used, us);
      if (over) return Outcome::converged;
      const RunStatus status{"motion", static_cast<double>(step) / static_cast<double>(steps),
                             static_cast<int>(iterations)};
      if (observer && !observer(status)) return Outcome::interrupted;
    }
    return Outcome::converged;
  }

  std::vector<double> cursor() const {
    std::vector<double> out = mover->pack();
    for (const long counter : {step, taken, iterations, resting}) out.push_back(static_cast<double>(counter));
    return out;
  }

  void start() {
    std::vector<geometry::State> shapes;
    for (const Scene* strip : strips_of(scene)) {
      const Ribbon& ribbon = mover->ribbon(shapes.size());
      Start start = start_of(*strip, ribbon);
      if (failure.empty()) failure = start.failure;
      shapes.push_back(start.failure.empty() ? std::move(start.shape) : geometry::straight_state(ribbon));
    }
    if (failure.empty() && meet(scene, shapes))
      failure = "a strip starts across itself or another strip, or touches it";
    mover->start(shapes);
  }

  void resume(const Progress& progress) {
    recording.records = progress.records;
    std::vector<double> numbers = progress.cursor;
    for (long* counter : {&resting, &iterations, &taken, &step}) {
      if (numbers.empty()) throw InputError("checkpoint: the stored solver state does not fit the stored scene");
      *counter = std::lround(numbers.back());
      numbers.pop_back();
    }
    mover->unpack(progress.records.back().states, numbers);
  }
};

}  // namespace

Ribbon motion_ribbon(const Scene& scene, double time) {
  geometry::RibbonSpec spec = scene.ribbon;
  spec.clamped = clamped_at(scene, time);
  return geometry::make_ribbon(spec);
}

std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

RunResult run_motion(const Scene& scene, const Observer& observer, const Progress* resume) {
  Motion motion(scene);
  RunResult result;
  if (resume) {
    motion.resume(*resume);
    result.outcome = motion.go(observer);
  } else {
    motion.start();
    motion.record(0, 0);
    if (motion.failure.empty()) result.outcome = motion.go(observer);
  }
  if (result.outcome == Outcome::not_converged && motion.recording.records.back().history.time < motion.time()) {
    motion.record(0, 0);  // the last good state
  }
  result.summary = summary_of(scene, motion.mover->ribbon(0), motion.recording.records.back(), result.outcome);
  result.summary.method = method_name(scene.solver.method);
  result.summary.steps = static_cast<int>(motion.step);
  result.summary.failure =
      result.outcome == Outcome::not_converged ? motion.failure + " (at " + text_of(motion.time()) + " s)" : "";
  result.summary.timing =
      motion.recording.finished(static_cast<int>(motion.taken), static_cast<int>(motion.iterations));
  motion.mover->add_findings(result.summary);
  result.progress = {std::move(motion.recording.records), motion.cursor()};
  return result;
}

}  // namespace wunderlich::scene
