/// A scene cut from its beginning, or held still: for motions that go on with another scene.
#pragma once

#include "wunderlich/scene/scene.hpp"

namespace wunderlich::web {

/// Calls `visit(strip)` for each strip of a scene.
template <class Visit>
void each_strip(scene::Scene& scene, const Visit& visit) {
  visit(scene);
  for (scene::Scene& strip : scene.beside) visit(strip);
}

/// The scene as seen from a later time [s], which becomes 0.
void begin_at(scene::Scene& scene, double time);

/// Everything stays where it is at a time [s].
void freeze(scene::Scene& scene, double time);

}  // namespace wunderlich::web
