/// How far a strip lets itself be changed and pulled in the shape that it has.
#pragma once

#include <string>

#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/scene.hpp"

namespace wunderlich::web {

/// At most so long.
Vec3 within(const Vec3& v, double most);

/// A place for a support, no farther from the others than the strip between them reaches.
Vec3 reachable(Vec3 point, std::size_t support, const scene::Scene& strip, double time);

/// Factors by which a strip is to change.
struct Scale {
  double length = 1, width = 1;
};

/// Takes back what the shape and the supports do not allow: rulings that meet, a length below what lies between two
/// supports. Says why; empty if nothing was taken back.
std::string limit(Scale& scale, const scene::Scene& strip, const geometry::State& state, double time);

}  // namespace wunderlich::web
