/// The models of a comparison, and what they share. Internal to scene/.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wunderlich/scene/compare.hpp"
#include "wunderlich/scene/recording.hpp"

namespace wunderlich::scene {

/// Parts of a ruling at which isometry is measured.
inline constexpr int kAcross = 8;

/// What came of a step that a model tried.
struct Tried {
  int iterations = 0;
  std::string failure;  ///< why it stayed where it was; empty if it got there
};

/// A model under way, as what runs it sees it.
struct Stepped {
  std::function<Tried(double time)> step_to;  ///< from where it is [s, or load parameter]
  std::function<bool()> is_over;              ///< asked after each step
  std::function<Mesh()> surface;
};

/// Number of steps of at most this size.
long steps_of(double time, double time_step);

/// Runs a model and keeps what a comparison wants of it: times of steps and frames of its surface. A step that fails is
/// tried in halves; where these fail as well, the result's `failure` says why.
class ModelLog {
 public:
  /// Frames count time in units of `unit` [s].
  ModelLog(const Scene& scene, Model model, double until, double unit, const Observer& observer);

  /// From 0 to `until` on a clock of its own, without frames: to where the run starts. False if it failed, or if the
  /// observer wants no more.
  bool approach(const Stepped& model, double until, long steps);
  /// From time 0 to the end.
  bool run(const Stepped& model, double time_step);
  /// Adds to a part of a step [s].
  void phase(const std::string& name, double seconds);
  void frame(double time, Mesh surface);

  ModelResult& result() { return result_; }
  /// Medians and means into the result; what depends on the strip's stiffness is made dimensionless there.
  ModelResult finished();

 private:
  Tried in_halves(const Stepped& model, double t0, double t1, int halvings);
  bool count_step(double time, double seconds, int iterations);
  bool wants_frame(double time);

  const Scene& scene_;
  const Observer& observer_;
  ModelResult result_;
  std::vector<double> step_us_;
  double until_, unit_, next_frame_ = 0;
  long iterations_ = 0;
};

/// The same supports, loads and obstacles with their keys `factor` times as far apart.
constraint::Surroundings stretched(const constraint::Surroundings& surroundings, double factor);

/// The same as they are at a time, for ever.
constraint::Surroundings standing_at(const constraint::Surroundings& surroundings, double time);

/// What brings a model to the surroundings of time 0 while time goes from 0 to 1: supports come from its own poses
/// there, loads grow from nothing. Solids stand.
constraint::Surroundings approach_to(const constraint::Surroundings& surroundings, const std::vector<Pose>& own);

/// Has any of its supports a way to go?
bool is_away(const constraint::Surroundings& approach, double length);

/// The same scene on so many segments of equal length: supports and loads at the nodes nearest to theirs, those at ends
/// of the strip at its ends.
Scene with_segments(const Scene& scene, int segments);

/// How far along the strip a support or a load of the second scene is from its place in the first, at most [m].
double largest_shift(const Scene& scene, const Scene& other);

/// Which supports, apart in the first scene, stand on one node of the second; empty if none do.
std::string fallen_together(const Scene& scene, const Scene& other);

ModelResult run_rod(const Scene& scene, const Observer& observer);
ModelResult run_shell(const Scene& scene, Model model, const Observer& observer);

}  // namespace wunderlich::scene
