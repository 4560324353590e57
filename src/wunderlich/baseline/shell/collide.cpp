#include "wunderlich/baseline/shell/collide.hpp"

#include <algorithm>

#include "wunderlich/baseline/shell/step.hpp"
#include "wunderlich/contact/shape.hpp"

namespace wunderlich::baseline::shell {

namespace {

Pose pose_of(const constraint::Obstacle& obstacle, double time) {
  return obstacle.motion.keys.empty() ? Pose{} : constraint::pose_at(obstacle.motion, time);
}

/// Where a point of a solid is carried from one pose to the other.
Vec3 carried(const Pose& from, const Pose& to, const Vec3& point) {
  return to.position + to.frame * (from.frame.conjugate() * (point - from.position));
}

}  // namespace

int push_out(const Shell& shell, const constraint::Surroundings& surroundings, const Hold& hold, const State& before,
             double t1, Points& x) {
  int touching = 0;
  for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
    const Pose from = pose_of(obstacle, before.time), to = pose_of(obstacle, t1);
    for (int p = 0; p < shell.point_count(); ++p) {
      if (std::any_of(hold.unknown.begin(), hold.unknown.end(),
                      [&](const auto& axis) { return axis[static_cast<std::size_t>(p)] < 0; })) {
        continue;
      }
      const Vec3 at = x.row(p).transpose();
      const contact::Distance gap = contact::distance(obstacle.shape, to, at);
      const double depth = surroundings.contact.thickness - gap.value;
      if (depth <= 0) continue;
      ++touching;
      const Vec3 old = before.x.row(p).transpose();
      const Vec3 moved = at - carried(from, to, old);
      const Vec3 slip = moved - moved.dot(gap.normal) * gap.normal;
      const double share = slip.norm() > 0 ? std::min(1.0, obstacle.friction * depth / slip.norm()) : 0;
      x.row(p) += (depth * gap.normal - share * slip).transpose();
    }
  }
  return touching;
}

}  // namespace wunderlich::baseline::shell
