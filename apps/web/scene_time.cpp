#include "scene_time.hpp"

#include <algorithm>

#include "wunderlich/constraint/support.hpp"

namespace wunderlich::web {

using constraint::Support;
using constraint::Surroundings;

namespace {

template <class Keys>
void shift(Keys& keys, double time) {
  for (auto& key : keys) key.time -= time;
}

}  // namespace

void begin_at(scene::Scene& all, double time) {
  each_strip(all, [&](scene::Scene& strip) {
    Surroundings& s = strip.surroundings;
    for (Support& support : s.supports) {
      shift(support.motion.keys, time);
      support.release -= time;
    }
    const auto gone = [](const Support& support) { return support.release <= 0; };
    s.supports.erase(std::remove_if(s.supports.begin(), s.supports.end(), gone), s.supports.end());
    for (constraint::Load& load : s.loads) shift(load.keys, time);
    for (constraint::Obstacle& obstacle : s.obstacles) shift(obstacle.motion.keys, time);
  });
}

void freeze(scene::Scene& all, double time) {
  each_strip(all, [&](scene::Scene& strip) {
    const auto hold = [&](constraint::Motion& motion) { motion.keys = {{0, constraint::pose_at(motion, time), 0}}; };
    for (Support& support : strip.surroundings.supports) hold(support.motion);
    for (constraint::Obstacle& obstacle : strip.surroundings.obstacles) hold(obstacle.motion);
    for (constraint::Load& load : strip.surroundings.loads) {
      constraint::LoadKey key = constraint::load_at(load, time);
      key.time = 0;
      load.keys = {key};
    }
  });
}

}  // namespace wunderlich::web
