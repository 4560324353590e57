/// The models of a comparison, and what they share. Internal to scene/.
#pragma once

#include "wunderlich/scene/compare.hpp"
#include "wunderlich/scene/recording.hpp"

namespace wunderlich::scene {

/// What a comparison keeps of a model while it runs: times of steps and frames of its surface.
class ModelLog {
 public:
  ModelLog(const Scene& scene, Model model, double until, const Observer& observer);

  /// After a step that ended at `time` [s] and took so long; false if the observer wants no more.
  bool step(double time, double seconds, int iterations);
  /// Adds to a part of a step [s].
  void phase(const std::string& name, double seconds);
  /// Is a frame due at this time? The first and the last are taken without asking.
  bool wants_frame(double time);
  void frame(double time, Mesh surface);

  ModelResult& result() { return result_; }
  /// Medians and means into the result.
  ModelResult finished();

 private:
  const Scene& scene_;
  const Observer& observer_;
  ModelResult result_;
  std::vector<double> step_us_;
  double until_, next_frame_ = 0;
  long iterations_ = 0;
};

/// The same supports, loads and obstacles with their keys `factor` times as far apart.
constraint::Surroundings stretched(const constraint::Surroundings& surroundings, double factor);

ModelResult run_rod(const Scene& scene, const Observer& observer);
ModelResult run_shell(const Scene& scene, Model model, const Observer& observer);

}  // namespace wunderlich::scene
