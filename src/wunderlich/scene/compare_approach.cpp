#include <algorithm>
#include <cmath>

#include "wunderlich/scene/compare_models.hpp"

namespace wunderlich::scene {

constraint::Surroundings stretched(const constraint::Surroundings& surroundings, double factor) {
  constraint::Surroundings out = surroundings;
  for (constraint::Support& support : out.supports) {
    for (constraint::PoseKey& key : support.motion.keys) key.time *= factor;
    support.release *= factor;
  }
  for (constraint::Load& load : out.loads) {
    for (constraint::LoadKey& key : load.keys) key.time *= factor;
  }
  for (constraint::Obstacle& obstacle : out.obstacles) {
    for (constraint::PoseKey& key : obstacle.motion.keys) key.time *= factor;
  }
  return out;
}

constraint::Surroundings standing_at(const constraint::Surroundings& surroundings, double time) {
  constraint::Surroundings out = surroundings;
  const auto stand = [&](constraint::Motion& motion) { motion.keys = {{0, constraint::pose_at(motion, time), 0}}; };
  for (constraint::Support& support : out.supports) stand(support.motion);
  for (constraint::Obstacle& obstacle : out.obstacles) stand(obstacle.motion);
  for (constraint::Load& load : out.loads) {
    const constraint::LoadKey key = constraint::load_at(load, time);
    load.keys = {{0, key.force, key.torque}};
  }
  return out;
}

constraint::Surroundings approach_to(const constraint::Surroundings& surroundings, const std::vector<Pose>& own) {
  constraint::Surroundings out = standing_at(surroundings, 0);
  for (std::size_t k = 0; k < out.supports.size(); ++k) {
    constraint::Motion& motion = out.supports[k].motion;
    motion.keys = {{0, own[k], 0}, {1, motion.keys.front().pose, 0}};
  }
  for (constraint::Load& load : out.loads) {
    constraint::LoadKey key = load.keys.front();
    key.time = 1;
    load.keys = {{0, Vec3::Zero(), Vec3::Zero()}, key};
  }
  return out;
}

bool is_away(const constraint::Surroundings& approach, double length) {
  constexpr double kThere = 1e-9;
  return std::any_of(approach.supports.begin(), approach.supports.end(), [&](const constraint::Support& support) {
    const Pose &own = support.motion.keys.front().pose, &goal = support.motion.keys.back().pose;
    const Vec3 way = goal.position - own.position;
    for (int c = 0; c < 3; ++c) {
      if (support.hold_position[static_cast<std::size_t>(c)] && std::abs(way[c]) > kThere * length) return true;
    }
    return support.orientation == constraint::Orientation::full && own.frame.angularDistance(goal.frame) > kThere;
  });
}

}  // namespace wunderlich::scene
