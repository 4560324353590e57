/// A motion whose caller takes the steps, and may change what is imposed on it between them: for the bindings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/scene.hpp"

namespace wunderlich::scene {

/// The steps are those of `run`: halved where they fail, and ended where a support lets go. One thread at a time.
class Stepper {
 public:
  /// From the scene's own start, at time 0. Throws InputError if the scene is not one of a motion, or a strip starts
  /// inside a solid. If the start is not reached `failure` says why, and there are no steps.
  explicit Stepper(Scene scene);
  /// From these states instead, one a strip, of as many segments: their shapes and the velocities of their nodes.
  /// Throws InputError if they do not fit the scene.
  Stepper(Scene scene, std::vector<geometry::State> start);
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;
  ~Stepper();

  /// Back to the start, with the scene as it was given.
  void reset();

  /// To the time `until` [s] in one step; to the next multiple of the scene's time step if `until` is not later
  /// than the time reached. False if it did not succeed; `failure` then says why, and the state is the last good one.
  bool step(double until = 0);

  /// What surrounds a strip from now on; its gravity becomes that of all strips. Supports and loads may move, come and
  /// go: `constraint::move_to` moves one from where it is. Nodes and segments must be those of the strip.
  void change(std::size_t strip, constraint::Surroundings surroundings);

  const Scene& scene() const;  ///< with all changes
  double time() const;         ///< [s]
  const std::string& failure() const;
  const std::vector<geometry::State>& states() const;  ///< now, one a strip; the next step overwrites them
  HistoryRow history() const;                          ///< energies and errors now, with the cost of the last step
  Frame frame() const;                                 ///< the exporter's view of the same

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wunderlich::scene
