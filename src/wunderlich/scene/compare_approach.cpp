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

constraint::Surroundings approach_to(const constraint::Surroundings& surroundings, const std::vector<Pose>& own) {
  constraint::Surroundings out = surroundings;
  for (std::size_t k = 0; k < out.supports.size(); ++k) {
    constraint::Motion& motion = out.supports[k].motion;
    motion.keys = {{0, own[k], 0}, {1, constraint::pose_at(motion, 0), 0}};
  }
  for (constraint::Load& load : out.loads) {
    const constraint::LoadKey key = constraint::load_at(load, 0);
    load.keys = {{0, Vec3::Zero(), Vec3::Zero()}, {1, key.force, key.torque}};
  }
  for (constraint::Obstacle& obstacle : out.obstacles)
    obstacle.motion.keys = {{0, constraint::pose_at(obstacle.motion, 0), 0}};
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
