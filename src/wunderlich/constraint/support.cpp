#include "wunderlich/constraint/support.hpp"

#include <algorithm>
#include <cassert>

namespace wunderlich::constraint {

namespace {

/// The two keys around `time` and how far it stands between them; equal keys outside the keyed interval.
template <typename Key>
struct Bracket {
  const Key& before;
  const Key& after;
  double fraction = 0;
};

template <typename Key>
Bracket<Key> bracket(const std::vector<Key>& keys, double time) {
  assert(!keys.empty());
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& k) { return t < k.time; });
  if (after == keys.begin()) return {keys.front(), keys.front(), 0};
  if (after == keys.end()) return {keys.back(), keys.back(), 0};
  const Key& before = *std::prev(after);
  return {before, *after, (time - before.time) / (after->time - before.time)};
}

// Exact at both ends, so that a key is met to the last bit.
template <typename Value>
Value mix(const Value& a, const Value& b, double fraction) {
  return (1 - fraction) * a + fraction * b;
}

}  // namespace

Pose pose_at(const Motion& motion, double time) {
  const auto [before, after, fraction] = bracket(motion.keys, time);
  Pose pose;
  pose.position = mix(before.pose.position, after.pose.position, fraction);
  const double turn = mix(before.turn, after.turn, fraction);
  pose.frame = before.pose.frame.slerp(fraction, after.pose.frame) * Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
  return pose;
}

double end_time(const Motion& motion) {
  assert(!motion.keys.empty());
  return motion.keys.back().time;
}

void move_to(const PoseKey& target, double now, Motion& motion) {
  assert(target.time > now);
  motion.keys = {{now, pose_at(motion, now), 0}, target};
}

LoadKey load_at(const Load& load, double time) {
  const auto [before, after, fraction] = bracket(load.keys, time);
  return {time, mix(before.force, after.force, fraction), mix(before.torque, after.torque, fraction)};
}

}  // namespace wunderlich::constraint
