/// Where a motion starts. Internal to scene/.
#pragma once

#include <string>

#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/scene.hpp"

namespace wunderlich::scene {

struct Start {
  geometry::State shape;
  std::string failure;  ///< why no such state was reached; empty if it was
};

/// The state of `scene.initial` on the strip as it is held at time 0.
Start start_of(const Scene& scene, const geometry::Ribbon& ribbon);

/// A barrier keeps apart what is apart: do strips that feel themselves and one another cross or touch from the start?
bool meet(const Scene& scene, const std::vector<geometry::State>& shapes);

}  // namespace wunderlich::scene
