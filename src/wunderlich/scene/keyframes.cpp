#include "wunderlich/scene/keyframes.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/scene/build.hpp"

namespace wunderlich::scene {

Vec3 direction(const Cell& cell) {
  const Vec3 v = vector(cell);
  if (!(v.norm() > 1e-9)) fail(cell, "is (nearly) zero; a direction must be longer than 1e-9");
  return v.normalized();
}

Quat frame_of(const Axes& axes, const AxisNames& names, const Cell& cell) {
  const double cosine = axes.d3.dot(axes.d1);
  if (std::abs(cosine) > 1e-6) {
    fail(cell,
         fmt::format("{0} and {1} must be perpendicular; they stand at {2:.4f} degrees (a {1} that is not given "
                     "is {3}, or that of the keyframe before)",
                     names.d3, names.d1, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / EIGEN_PI, names.d1_fallback));
  }
  const Vec3 d1 = (axes.d1 - cosine * axes.d3).normalized();
  Mat3 rotation;
  rotation << d1, axes.d3.cross(d1), axes.d3;
  return Quat(rotation);
}

void check_half_turn(const Cell& keyframe, const std::vector<constraint::PoseKey>& keys, const std::string& axis) {
  if (keys.size() < 2) return;
  const double angle = keys[keys.size() - 2].pose.frame.angularDistance(keys.back().pose.frame);
  if (angle < EIGEN_PI - 1e-6) return;
  fail(keyframe, fmt::format("the frame turns by half a turn from the keyframe before, so its way is not defined; use "
                             "`turn` for turns about the {}, or a keyframe in between",
                             axis));
}

}  // namespace wunderlich::scene
