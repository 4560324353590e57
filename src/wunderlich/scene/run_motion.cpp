#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/motion.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;

namespace {

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

/// One run of a motion under way.
struct MotionRun {
  explicit MotionRun(const Scene& scene) : motion(scene) {}

  Motion motion;
  long step = 0;  ///< of the scene's own steps
  long iterations = 0;
  long resting = 0;

  const Scene& scene() const { return motion.scene; }
  long step_count() const {
    return std::max(1L, std::lround(std::ceil(scene().solver.duration / scene().solver.time_step - 1e-9)));
  }
  double time_of(long number) const {
    return number >= step_count() ? scene().solver.duration : static_cast<double>(number) * scene().solver.time_step;
  }

  void record(int used, double us) {
    motion.recording.records.push_back({motion.mover->shapes(), motion.history(used, us)});
  }

  /// When the last thing that the scene imposes has happened.
  double last_event() const {
    double last = 0;
    visit_supports(scene(), [&](const constraint::Support& support) {
      last = std::max(last, end_time(support.motion));
      if (std::isfinite(support.release)) last = std::max(last, support.release);
    });
    for (const Scene* strip : strips_of(scene())) {
      for (const constraint::Load& load : strip->surroundings.loads) last = std::max(last, load.keys.back().time);
    }
    return last;
  }

  /// Slower than a wave of bending would cross 1e-5 of the strip in the time it takes along the strip.
  bool is_resting() const {
    if (motion.time() < last_event()) return false;
    for (std::size_t i = 0; i < motion.mover->shapes().size(); ++i) {
      const Ribbon& ribbon = motion.mover->ribbon(i);
      const double slow = 1e-5 * std::sqrt(ribbon.bending_stiffness / ribbon.area_density) / ribbon.length;
      for (const Vec3& v : motion.mover->shapes()[i].r_dot) {
        if (!(v.norm() < slow)) return false;
      }
    }
    return true;
  }

  Outcome go(const Observer& observer) {
    const long steps = step_count();
    const long most = std::max(1, scene().output.frames - 1);  // beside the start
    const long stride = std::max(1L, (steps + most - 1) / most);
    while (step < steps) {
      const Stopwatch watch;
      int used = 0;
      if (!motion.advance_to(time_of(step + 1), used)) return Outcome::not_converged;
      ++step;
      const double us = 1e6 * watch.seconds();
      motion.recording.timing.wall_seconds += 1e-6 * us;
      motion.recording.step_us.push_back(us);
      iterations += used;
      resting = is_resting() ? resting + 1 : 0;
      const bool over = step == steps || (scene().solver.stop_at_rest && resting >= kRestingSteps);
      if (over || step % stride == 0) record(used, us);
      if (over) return Outcome::converged;
      const RunStatus status{"motion", static_cast<double>(step) / static_cast<double>(steps),
                             static_cast<int>(iterations)};
      if (observer && !observer(status)) return Outcome::interrupted;
    }
    return Outcome::converged;
  }

  std::vector<double> cursor() const {
    std::vector<double> out = motion.mover->pack();
    for (const long counter : {step, motion.taken, iterations, resting}) out.push_back(static_cast<double>(counter));
    return out;
  }

  void resume(const Progress& progress) {
    motion.recording.records = progress.records;
    std::vector<double> numbers = progress.cursor;
    for (long* counter : {&resting, &iterations, &motion.taken, &step}) {
      if (numbers.empty()) throw InputError("checkpoint: the stored solver state does not fit the stored scene");
      *counter = std::lround(numbers.back());
      numbers.pop_back();
    }
    motion.mover->unpack(progress.records.back().states, numbers);
  }
};

}  // namespace

Ribbon motion_ribbon(const Scene& scene, double time) {
  geometry::RibbonSpec spec = scene.ribbon;
  spec.clamped = clamped_at(scene, time);
  return geometry::make_ribbon(spec);
}

RunResult run_motion(const Scene& scene, const Observer& observer, const Progress* resume) {
  MotionRun under_way(scene);
  Motion& motion = under_way.motion;
  RunResult result;
  if (resume) {
    under_way.resume(*resume);
    result.outcome = under_way.go(observer);
  } else {
    motion.start();
    under_way.record(0, 0);
    if (motion.failure.empty()) result.outcome = under_way.go(observer);
  }
  if (result.outcome == Outcome::not_converged && motion.recording.records.back().history.time < motion.time()) {
    under_way.record(0, 0);  // the last good state
  }
  result.summary = summary_of(scene, motion.mover->ribbon(0), motion.recording.records.back(), result.outcome);
  result.summary.method = method_name(scene.solver.method);
  result.summary.steps = static_cast<int>(under_way.step);
  result.summary.failure =
      result.outcome == Outcome::not_converged ? motion.failure + " (at " + text_of(motion.time()) + " s)" : "";
  result.summary.timing =
      motion.recording.finished(static_cast<int>(motion.taken), static_cast<int>(under_way.iterations));
  motion.mover->add_findings(result.summary);
  result.progress = {std::move(motion.recording.records), under_way.cursor()};
  return result;
}

}  // namespace wunderlich::scene
