/// A motion under way, whoever decides on its steps. Internal to scene/.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wunderlich/scene/mover.hpp"

namespace wunderlich::scene {

struct Motion {
  /// `scene` must outlive it.
  explicit Motion(const Scene& scene);

  /// From the scene's own start, or from these shapes at time 0; `failure` says why if it was not reached.
  void start();
  void start(const std::vector<geometry::State>& shapes);

  /// Up to t1, with a stop wherever a support lets go; a step that fails is tried again in halves. Adds to `used` what
  /// iterations it took. False, with `failure`, if it did not succeed: it is then where the last good step ended.
  bool advance_to(double t1, int& used);

  double time() const { return mover->shapes().front().time; }
  HistoryRow history(int used, double us) const;

  const Scene& scene;
  std::unique_ptr<Mover> mover;
  Recording recording;
  long taken = 0;       ///< steps that succeeded, parts of halved ones included
  std::string failure;  ///< of the last attempt that failed

 private:
  bool advance(double t0, double t1, int halvings, int& used);
  bool released(double t0, double t1) const;
};

/// Calls `visit` with every support of every strip.
template <class Visit>
void visit_supports(const Scene& scene, const Visit& visit) {
  for (const Scene* strip : strips_of(scene)) {
    for (const constraint::Support& support : strip->surroundings.supports) visit(support);
  }
}

}  // namespace wunderlich::scene
