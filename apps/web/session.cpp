#include "session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "reach.hpp"
#include "scene_time.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::web {

using constraint::Support;
using constraint::Surroundings;

namespace {

constexpr double kSteps = 120;         // a second shown
constexpr double kHandSpeed = 2.5;     // lengths a second shown
constexpr double kTurnSpeed = 6;       // radians a second shown
constexpr double kPull = 0.06;         // of the length, farthest that a hand pulls ahead of what it holds
constexpr double kLead = 1;            // radians, farthest that it turns ahead
constexpr double kChange = 0.01;       // of length, width, stiffness in a step
constexpr double kPathPace = 1.0 / 3;  // a strip's own time, in which a wave of bending crosses it, takes three seconds
constexpr double kPathDamping = 3;     // a second shown, of motions that go on from an equilibrium
constexpr int kSegments = 2000;        // of all strips: a step of more is not one frame's work
constexpr std::size_t kFilm = 72;      // frames
constexpr double kFilmRate = 12;       // a second shown

double towards(double now, double wanted, double most) { return now + std::clamp(wanted - now, -most, most); }

/// A factor on the way from one value to another, at most `kChange` from 1.
double factor(double now, double wanted) { return std::clamp(wanted / now, 1 - kChange, 1 + kChange); }

/// Time in which a wave of bending crosses the strip.
double own_time(const geometry::RibbonSpec& ribbon) {
  return ribbon.length * ribbon.length * std::sqrt(ribbon.area_density / ribbon.bending_stiffness);
}

Settings settings_of(const scene::Scene& scene) {
  const geometry::RibbonSpec& ribbon = scene.ribbon;
  return {ribbon.length,
          ribbon.width,
          ribbon.bending_stiffness,
          0,
          scene.solver.implicit.drag_normal,
          scene.surroundings.gravity};
}

bool at_far_end(const Support& support, const geometry::RibbonSpec& ribbon) {
  return support.node == ribbon.segments || support.segment == ribbon.segments - 1;
}

/// The frame turned towards another, by no more than an angle: a spring between frames half a turn apart would snap.
Quat near(const Quat& from, const Quat& to, double angle) {
  const double way = from.angularDistance(to);
  return (way <= angle ? to : from.slerp(angle / way, to)).normalized();
}

}  // namespace

Session::Session(scene::Scene scene) : scene_(std::move(scene)) {
  int segments = 0;
  for (const scene::Scene* strip : scene::strips_of(scene_)) segments += strip->ribbon.segments;
  if (segments > kSegments) {
    throw InputError(fmt::format("ribbon.segments: {} in all; here at most {} are taken, the program takes more",
                                 segments, kSegments));
  }
  // Smooth enough to look at, small enough for sixty frames a second.
  scene_.output.subdivision = scene_.ribbon.segments <= 60 ? 3 : scene_.ribbon.segments <= 150 ? 2 : 1;
  scene_.output.across = 4;
  each_strip(scene_, [&](scene::Scene& strip) { strip.output = scene_.output; });
  if (scene_.solver.method == scene::Method::equilibrium) {
    pace_ = kPathPace * own_time(scene_.ribbon);
    step_ = pace_ / kSteps;
    scene_.solver.implicit.drag_normal = scene_.solver.implicit.drag_tangent = kPathDamping / pace_;
    given_ = now_ = wanted_ = settings_of(scene_);
    follow(0);
    return;
  }
  scene::Scene live = scene_;
  step_ = live.solver.method == scene::Method::implicit ? std::min(live.solver.time_step, 1 / kSteps) : 1 / kSteps;
  live.solver.method = scene::Method::implicit;
  given_ = now_ = wanted_ = settings_of(scene_);
  start_motion(std::move(live), {});
}

/// The motion before it goes on where this one is refused.
void Session::start_motion(scene::Scene scene, std::vector<geometry::State> states) {
  motion_ = states.empty() ? scene::Stepper(std::move(scene)) : scene::Stepper(std::move(scene), std::move(states));
  failure_ = motion_->failure();
  film_.clear();
  keep_film();
}

bool Session::follow(double milliseconds) {
  if (!on_path() || summary_) return false;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double, std::milli>(milliseconds);
  const auto observer = [&](const scene::RunStatus& status) {
    phase_ = status.phase;
    share_ = status.fraction;
    return Clock::now() < end;
  };
  const bool begun = !progress_.records.empty();
  scene::RunResult result = scene::run(scene_, observer, begun ? &progress_ : nullptr);
  progress_ = std::move(result.progress);
  if (result.outcome == scene::Outcome::interrupted) return true;
  failure_ = result.summary.failure;
  summary_ = std::move(result.summary);
  // A loop that has not closed is no strip to go on with.
  const bool closed = result.outcome == scene::Outcome::converged;
  if (closed || scene_.ribbon.closure == geometry::Closure::open) go_live();
  return false;
}

/// From the end of the path on, or from where it failed, as a motion.
void Session::go_live() {
  scene::Scene live = scene_;
  freeze(live, live.solver.duration);
  live.solver.method = scene::Method::implicit;
  std::vector<geometry::State> states = progress_.records.back().states;
  const std::string failure = failure_;
  start_motion(std::move(live), std::move(states));
  if (!failure.empty()) failure_ = failure;
}

/// The motion goes on with another scene; `edit(scene, states)`.
template <class Edit>
void Session::remake(const Edit& edit) {
  scene::Scene scene = motion_->scene();
  std::vector<geometry::State> states = motion_->states();
  begin_at(scene, motion_->time());
  // Supports that are released go, and the others' numbers change: a hand no longer knows its own.
  const auto supports = [&](const scene::Scene& all) {
    return scene::strips_of(all)[hand_->strip]->surroundings.supports.size();
  };
  if (hand_ && supports(scene) != supports(motion_->scene())) hand_.reset();
  const double passed = motion_->time();
  edit(scene, states);
  start_motion(std::move(scene), std::move(states));
  elapsed_ += passed;
}

bool Session::reshapes() const {
  return now_.length != wanted_.length || now_.width != wanted_.width || now_.stiffness != wanted_.stiffness ||
         now_.damping != wanted_.damping;
}

/// Length, width, stiffness and damping a little nearer to what is wanted.
void Session::reshape() {
  if (!reshapes()) return;
  Scale scale{factor(now_.length, wanted_.length), factor(now_.width, wanted_.width)};
  const double stiffness = factor(now_.stiffness, wanted_.stiffness);
  const std::vector<const scene::Scene*> strips = scene::strips_of(motion_->scene());
  std::string remark;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const std::string why = limit(scale, *strips[i], motion_->states()[i], motion_->time());
    if (!why.empty()) remark = why;
  }
  Settings next = now_;
  next.length *= scale.length;
  next.width *= scale.width;
  next.stiffness *= stiffness;
  next.damping = wanted_.damping;
  if (std::abs(next.length - wanted_.length) < 1e-12) next.length = wanted_.length;
  // What goes no further is wanted no more.
  if (scale.length == 1) wanted_.length = next.length;
  if (scale.width == 1) wanted_.width = next.width;
  remake([&](scene::Scene& scene, std::vector<geometry::State>& shapes) {
    std::size_t i = 0;
    scene.solver.implicit.drag_normal = scene.solver.implicit.drag_tangent = next.damping;
    each_strip(scene, [&](scene::Scene& strip) {
      strip.ribbon.length *= scale.length;
      strip.ribbon.width *= scale.width;
      strip.ribbon.bending_stiffness *= stiffness;
      const auto& supports = strip.surroundings.supports;
      const Vec3 still = supports.empty() ? shapes[i].r[shapes[i].r.size() / 2]
                                          : shapes[i].r[static_cast<std::size_t>(supports.front().node)];
      for (Vec3& r : shapes[i].r) r = still + scale.length * (r - still);
      ++i;
    });
  });
  now_ = next;
  failure_ = remark;
}

void Session::set(const Settings& settings) { wanted_ = settings; }

double Session::time() const { return motion_ ? elapsed_ + motion_->time() : 0; }

const std::vector<geometry::State>& Session::states() const {
  return motion_ ? motion_->states() : progress_.records.back().states;
}

HistoryRow Session::history() const { return motion_ ? motion_->history() : progress_.records.back().history; }

Frame Session::frame() const { return motion_ ? motion_->frame() : scene::frame_of(scene_, progress_.records.back()); }

void Session::keep_film() {
  if (!film_.empty() && motion_->time() < film_.back().history.time + pace_ / kFilmRate) return;
  if (film_.size() == kFilm) film_.erase(film_.begin());
  film_.push_back({motion_->states(), motion_->history()});
}

Film Session::film() const {
  const bool path = on_path() || (film_.size() < 2 && !progress_.records.empty());
  const scene::Scene& shown = path ? scene_ : motion_->scene();
  Film film;
  for (const scene::Record& record : path ? progress_.records : film_) {
    film.frames.push_back(scene::frame_of(shown, record));
  }
  if (!path && film_.back().history.time < motion_->time()) film.frames.push_back(motion_->frame());
  std::vector<double> times;
  for (const Frame& frame : film.frames) times.push_back(frame.time);
  film.bodies = scene::bodies_of(shown, times);
  return film;
}

void Session::grab(std::size_t strip, int node) {
  hand_.reset();
  if (on_path() || strip >= states().size()) return;
  const scene::Scene& own = *scene::strips_of(motion_->scene())[strip];
  const int segments = own.ribbon.segments, near = std::max(1, segments / 25);
  Hand hand;
  hand.strip = strip;
  hand.segment = std::clamp(node, 0, segments - 1);
  const auto& supports = own.surroundings.supports;
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const bool whole = supports[k].hold_position == std::array<bool, 3>{true, true, true};
    const bool there = motion_->time() < supports[k].release;
    if (whole && there && std::abs(supports[k].node - node) <= near) hand.support = static_cast<int>(k);
  }
  const geometry::State& state = states()[strip];
  const auto s = static_cast<std::size_t>(hand.segment);
  hand.target =
      hand.support >= 0
          ? constraint::pose_at(supports[static_cast<std::size_t>(hand.support)].motion, motion_->time()).position
          : Vec3(0.5 * (state.r[s] + state.r[s + 1]));
  hand.frame = state.q[s];
  hand_ = hand;
}

void Session::drag(const Vec3& target) {
  if (hand_) hand_->target = target;
}

void Session::turn(double angle) {
  if (hand_) hand_->turn += angle;
}

void Session::let_go() { hand_.reset(); }

/// Where the hand has the strip at the end of a step.
void Session::move_hand(double seconds, Surroundings& surroundings) {
  const double now = motion_->time(), share = seconds / pace_;
  const scene::Scene& own = *scene::strips_of(motion_->scene())[hand_->strip];
  const double length = own.ribbon.length, angle = std::clamp(hand_->turn, -kTurnSpeed * share, kTurnSpeed * share);
  hand_->turn -= angle;
  const Quat turn = math::exp_map(Vec3(0, 0, angle));
  if (hand_->support >= 0) {
    const auto k = static_cast<std::size_t>(hand_->support);
    Pose pose = constraint::pose_at(surroundings.supports[k].motion, now);
    pose.position =
        reachable(pose.position + within(hand_->target - pose.position, kHandSpeed * length * share), k, own, now);
    pose.frame = pose.frame * turn;
    constraint::move_to({now + seconds, pose, 0}, now, surroundings.supports[k].motion);
    return;
  }
  const geometry::State& state = motion_->states()[hand_->strip];
  const auto s = static_cast<std::size_t>(hand_->segment);
  const Vec3 middle = 0.5 * (state.r[s] + state.r[s + 1]);
  const geometry::RibbonSpec& r = own.ribbon;
  const double mass = r.area_density * r.length * r.width, bending = r.bending_stiffness * r.width;
  const double rate = 20 / pace_;
  const double stiffness =
      300 * bending / std::pow(length, 3) + 40 * mass * now_.gravity.norm() / length + mass * rate * rate;
  // A dashpot as well, so that what is pulled does not swing about the hand.
  const double drag = std::sqrt(stiffness * mass) / seconds;
  constraint::Grip grip;
  grip.segment = hand_->segment;
  grip.stiffness = stiffness + drag;
  const Vec3 ahead = within(hand_->target - middle, kPull * length);
  grip.target.position = middle + (stiffness / grip.stiffness) * ahead;
  if (angle != 0 && !hand_->turned) hand_->frame = state.q[s];
  hand_->turned = hand_->turned || angle != 0;
  hand_->frame = near(state.q[s], hand_->frame * turn, kLead);
  if (hand_->turned) grip.turn_stiffness = 30 * bending / length;
  grip.target.frame = hand_->frame;
  surroundings.grips.push_back(grip);
}

/// Turns the far end of the first strip about its tangent: its support, else a spring on its last segment.
void Session::twist_end(double seconds, Surroundings& surroundings) {
  if (now_.twist == wanted_.twist && !twisted_) return;
  const double now = motion_->time();
  const double before = now_.twist;
  now_.twist = towards(before, wanted_.twist, kTurnSpeed * seconds / pace_);
  const geometry::RibbonSpec& ribbon = motion_->scene().ribbon;
  for (Support& support : surroundings.supports) {
    if (support.orientation == constraint::Orientation::free || !at_far_end(support, ribbon)) continue;
    if (now_.twist == before) return;
    Pose pose = constraint::pose_at(support.motion, now);
    pose.frame = pose.frame * math::exp_map(Vec3(0, 0, now_.twist - before));
    constraint::move_to({now + seconds, pose, 0}, now, support.motion);
    return;
  }
  const Quat end = motion_->states().front().q.back();
  twisted_ = near(end, twisted_.value_or(end) * math::exp_map(Vec3(0, 0, now_.twist - before)), kLead);
  constraint::Grip grip;
  grip.segment = ribbon.segments - 1;
  grip.turn_stiffness = 30 * ribbon.bending_stiffness * ribbon.width / ribbon.length;
  grip.target.frame = *twisted_;
  surroundings.grips.push_back(grip);
  if (now_.twist == 0 && wanted_.twist == 0) twisted_.reset();
}

/// Gravity, and where supports and springs go in a step.
void Session::impose(double seconds) {
  const bool pulls = hand_ || twisted_ || now_.twist != wanted_.twist || now_.gravity != wanted_.gravity;
  now_.gravity = wanted_.gravity;
  const std::vector<const scene::Scene*> strips = scene::strips_of(motion_->scene());
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (!pulls && strips[i]->surroundings.grips.empty()) continue;
    Surroundings surroundings = strips[i]->surroundings;
    surroundings.grips.clear();
    surroundings.gravity = now_.gravity;
    if (i == 0) twist_end(seconds, surroundings);
    if (hand_ && hand_->strip == i) move_hand(seconds, surroundings);
    motion_->change(i, std::move(surroundings));
  }
}

bool Session::step(double seconds) {
  if (on_path()) return false;
  failure_.clear();
  const std::optional<Form> before = reshapes() ? std::optional<Form>(form()) : std::nullopt;
  try {
    reshape();
    impose(seconds);
    if (motion_->step(motion_->time() + seconds)) {
      keep_film();
      return true;
    }
    failure_ = motion_->failure();
  } catch (const InputError& error) {
    failure_ = error.what();
  } catch (const std::exception& error) {
    failure_ = std::string("this should not happen: ") + error.what();
  }
  const std::string failure = failure_;
  recover(before);
  failure_ = failure;
  return false;
}

Session::Form Session::form() const {
  Form form{now_, {}, motion_->states()};
  for (const scene::Scene* strip : scene::strips_of(motion_->scene())) form.ribbons.push_back(strip->ribbon);
  return form;
}

/// The last good state, with everything where it is there. A form that could not be reached is wanted no more.
void Session::recover(const std::optional<Form>& before) {
  const bool pulled = hand_ || wanted_.twist != now_.twist || twisted_;
  hand_.reset();
  twisted_.reset();
  wanted_.twist = now_.twist;
  if (before) {
    now_.length = wanted_.length = before->settings.length;
    now_.width = wanted_.width = before->settings.width;
    now_.stiffness = wanted_.stiffness = before->settings.stiffness;
  }
  remake([&](scene::Scene& scene, std::vector<geometry::State>& shapes) {
    if (before) shapes = before->states;
    std::size_t i = 0;
    each_strip(scene, [&](scene::Scene& strip) {
      if (before) strip.ribbon = before->ribbons[i];
      ++i;
      strip.surroundings.grips.clear();
      for (Support& support : strip.surroundings.supports) {
        if (!pulled) continue;
        support.motion.keys = {{0, constraint::pose_at(support.motion, 0), 0}};
      }
    });
    // What a hand has torn about stands still; else the next steps fail as well.
    for (geometry::State& shape : shapes) {
      if (pulled || before) std::fill(shape.r_dot.begin(), shape.r_dot.end(), Vec3::Zero());
    }
  });
}

}  // namespace wunderlich::web
