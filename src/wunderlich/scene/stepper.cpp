#include "wunderlich/scene/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/motion.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {

namespace {

using constraint::Support;

/// Do the same supports hold a strip at this time, if perhaps elsewhere?
bool same_supports(const std::vector<Support>& a, const std::vector<Support>& b, double time) {
  const auto held = [&](const std::vector<Support>& all) {
    std::vector<const Support*> out;
    for (const Support& support : all) {
      if (holds(support, time)) out.push_back(&support);
    }
    return out;
  };
  const std::vector<const Support*> x = held(a), y = held(b);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Support* p, const Support* q) {
    return p->node == q->node && p->segment == q->segment && p->orientation == q->orientation &&
           p->hold_position == q->hold_position;
  });
}

/// Do the same forces act at this time?
bool same_forces(const constraint::Surroundings& a, const constraint::Surroundings& b, double time) {
  return a.gravity == b.gravity && std::equal(a.loads.begin(), a.loads.end(), b.loads.begin(), b.loads.end(),
                                              [&](const constraint::Load& p, const constraint::Load& q) {
                                                const constraint::LoadKey x = load_at(p, time), y = load_at(q, time);
                                                return p.node == q.node && p.frame == q.frame && x.force == y.force &&
                                                       x.torque == y.torque;
                                              });
}

/// The strip of that number, to change it.
Scene& strip_of(Scene& scene, std::size_t strip) { return strip == 0 ? scene : scene.beside.at(strip - 1); }

void check_shapes(const Scene& scene, const std::vector<geometry::State>& shapes) {
  const std::vector<const Scene*> strips = strips_of(scene);
  const bool fits = std::equal(strips.begin(), strips.end(), shapes.begin(), shapes.end(),
                               [](const Scene* strip, const geometry::State& shape) {
                                 const auto n = static_cast<std::size_t>(strip->ribbon.segments);
                                 return shape.q.size() == n && shape.r.size() == n + 1 && shape.r_dot.size() == n + 1 &&
                                        shape.eta.size() == n + 1;
                               });
  if (!fits) throw InputError(scene.name + ": the given start has other strips or segments than the scene");
}

}  // namespace

struct Stepper::Parts {
  Parts(Scene as_given, std::vector<geometry::State> from)
      : given(std::move(as_given)), start(std::move(from)), scene(given), motion(scene) {
    if (start.empty()) {
      motion.start();
    } else {
      motion.start(start);
    }
    stuck = !motion.failure.empty();
  }

  const Scene given;
  const std::vector<geometry::State> start;  ///< empty: the scene's own
  Scene scene;
  Motion motion;
  bool stuck = false;  ///< the start was not reached
  int used = 0;
  double us = 0;
};

Stepper::Stepper(Scene scene) : Stepper(std::move(scene), {}) {}

Stepper::Stepper(Scene scene, std::vector<geometry::State> start) {
  if (scene.solver.method == Method::equilibrium) {
    throw InputError(scene.name + ": solver.method: equilibrium has no steps in time; `implicit` and `two-stage` have");
  }
  if (start.empty()) {
    check_start(scene);
  } else {
    check_shapes(scene, start);
    for (geometry::State& state : start) state.time = 0;
    for (std::size_t i = 0; i < start.size(); ++i) strip_of(scene, i).initial.spin.setZero();
  }
  parts_ = std::make_unique<Parts>(std::move(scene), std::move(start));
}

Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;
Stepper::~Stepper() = default;

void Stepper::reset() { parts_ = std::make_unique<Parts>(parts_->given, parts_->start); }

bool Stepper::step(double until) {
  Motion& motion = parts_->motion;
  if (parts_->stuck) return false;
  motion.failure.clear();
  const double t = motion.time(), h = parts_->scene.solver.time_step;
  const double next = until > t ? until : h * (std::floor(t / h + 1e-6) + 1);
  const Stopwatch watch;
  parts_->used = 0;
  const bool reached = motion.advance_to(next, parts_->used);
  parts_->us = 1e6 * watch.seconds();
  if (reached) motion.failure.clear();  // of attempts that halving saved
  return reached;
}

void Stepper::change(std::size_t strip, constraint::Surroundings surroundings) {
  constraint::Surroundings& own = strip_of(parts_->scene, strip).surroundings;
  const bool same =
      same_supports(own.supports, surroundings.supports, time()) && same_forces(own, surroundings, time());
  own = std::move(surroundings);
  const Vec3 gravity = own.gravity;
  for (std::size_t i = 0; i <= parts_->scene.beside.size(); ++i) {
    strip_of(parts_->scene, i).surroundings.gravity = gravity;
  }
  if (!same) parts_->motion.mover->release();
  if (same) parts_->motion.mover->follow();
}

const Scene& Stepper::scene() const { return parts_->scene; }
double Stepper::time() const { return parts_->motion.time(); }
const std::string& Stepper::failure() const { return parts_->motion.failure; }
const std::vector<geometry::State>& Stepper::states() const { return parts_->motion.mover->shapes(); }
HistoryRow Stepper::history() const { return parts_->motion.history(parts_->used, parts_->us); }
Frame Stepper::frame() const { return frame_of(parts_->scene, {states(), history()}); }

}  // namespace wunderlich::scene
