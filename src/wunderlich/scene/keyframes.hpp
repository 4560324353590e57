/// What clamps, pins, forces and obstacles share: directions, frames, and keyframes in increasing time.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/scene/schema.hpp"

namespace wunderlich::scene {

/// A direction of any length, made a unit vector; throws where it is (nearly) zero.
Vec3 direction(const Cell& cell);

/// The axes d3 and d1 as written; a frame only once both are known.
struct Axes {
  Vec3 d3;
  Vec3 d1;
};

/// What a file calls them, for messages.
struct AxisNames {
  std::string d3;
  std::string d1;
  std::string d1_fallback;
};

/// The frame with these axes; throws where they are not perpendicular.
Quat frame_of(const Axes& axes, const AxisNames& names, const Cell& cell);

/// Times must increase strictly; called with the keys read so far.
template <typename Key>
double next_time(const Cell& keyframe, const std::vector<Key>& keys) {
  const Cell cell = child(keyframe, "time");
  const double time = number(cell);
  if (!keys.empty() && !(time > keys.back().time)) {
    fail(cell, fmt::format("{:g} does not come after the keyframe before, at {:g}; times must increase", time,
                           keys.back().time));
  }
  return time;
}

/// Throws where the last key's frame stands half a turn from the one before; `axis` is what a file calls d3.
void check_half_turn(const Cell& keyframe, const std::vector<constraint::PoseKey>& keys, const std::string& axis);

}  // namespace wunderlich::scene
