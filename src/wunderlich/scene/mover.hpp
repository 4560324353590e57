/// A method of dynamics as a run sees it: something that takes steps. Internal to scene/.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/recording.hpp"
#include "wunderlich/scene/scene.hpp"

namespace wunderlich::scene {

/// What became of one step.
struct Move {
  bool accepted = false;
  int iterations = 0;
  std::string failure;  ///< why not
};

class Mover {
 public:
  virtual ~Mover() = default;
  virtual void start(const std::vector<geometry::State>& shapes) = 0;
  /// One step; a step that fails leaves everything as it was. Times of phases go to the recording.
  /// `halvings`: how often it has been halved.
  virtual Move step(double t0, double t1, int halvings, Recording& recording) = 0;
  /// Takes what holds and loads the strips from now on, after a support has let go or forces have changed at once.
  virtual void release() = 0;
  /// Takes where supports and loads go from now on; those of this instant are the same.
  virtual void follow() = 0;
  virtual const geometry::Ribbon& ribbon(std::size_t strip) const = 0;
  virtual const std::vector<geometry::State>& shapes() const = 0;  ///< one a strip, at least one
  virtual double kinetic_energy() const = 0;                       ///< [J]
  virtual void add_findings(Summary& summary) const = 0;
  /// The method's own state as numbers, and back; throws InputError if they do not fit.
  virtual std::vector<double> pack() const = 0;
  virtual void unpack(const std::vector<geometry::State>& shapes, const std::vector<double>& numbers) = 0;
};

std::unique_ptr<Mover> two_stage_mover(const Scene& scene);
std::unique_ptr<Mover> implicit_mover(const Scene& scene);

/// "0.001"
std::string text_of(double number);

}  // namespace wunderlich::scene
