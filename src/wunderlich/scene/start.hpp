/// Where a motion starts. Internal to scene/.
#pragma once

#include <optional>
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

/// A solid that the strip starts inside of, or too near to; or more solids than can be looked at.
struct Blocked {
  std::size_t obstacle;
  std::string why;
};

/// Looks at the points of a strip that starts straight or coiled; other starts are not known before the run.
std::optional<Blocked> blocked_start(const Scene& scene);

}  // namespace wunderlich::scene
