/// What clamps, pins, forces and obstacles share: directions, frames, and keyframes in increasing time.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/scene/build.hpp"

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

/// The keyframes below `cell`, each as the one before it, at first `key`, but for what it says; `read_frame(keyframe,
/// key)` takes what it says of the frame. Without keyframes `key` alone.
template <typename ReadFrame>
constraint::Motion motion_from(const Cell& cell, constraint::PoseKey key, const std::string& axis,
                               const ReadFrame& read_frame) {
  constraint::Motion motion;
  const Cell keyframes = child(cell, "keyframes");
  for (std::size_t i = 0; i < count(keyframes); ++i) {
    const Cell keyframe = element(keyframes, i);
    key.time = next_time(keyframe, motion.keys);
    if (const Cell c = child(keyframe, "position"); c.value != nullptr) key.pose.position = vector(c);
    read_frame(keyframe, key);
    motion.keys.push_back(key);
    check_half_turn(keyframe, motion.keys, axis);
  }
  if (motion.keys.empty()) motion.keys.push_back(key);
  return motion;
}

}  // namespace wunderlich::scene
