/// Triangles on a grid of samples.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "wunderlich/picture/camera.hpp"

namespace wunderlich::picture {

using Point = Eigen::Vector3f;

/// A corner of a triangle to be drawn.
struct Corner {
  Point position = Point::Zero();  ///< on the stage
  Point normal = Point::Zero();
  Point colour = Point::Zero();  ///< linear, not yet lit
};

/// A triangle in the picture: x, y in samples, and 1/depth, which is linear over the picture.
struct Patch {
  std::array<Corner, 3> corners;
  std::array<Vec3, 3> at;  // in double: of a floor that begins beside the eye, corners are far outside
  bool front = true;       ///< seen with its corners counter-clockwise
};

/// Samples from `left`, `top` up to but without `right`, `bottom`.
struct Window {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Stage to picture.
struct Projection {
  Camera camera;
  double scale = 1;  ///< samples per unit at distance 1
  Vec2 centre = Vec2::Zero();

  Projection(const Camera& from, int width, int height);

  /// Right, up and depth, before the division.
  Vec3 eye_space(const Vec3& p) const;
  Vec3 sample(const Vec3& eye_space) const;
};

/// Nothing nearer than this to the eye is drawn.
inline constexpr double near_plane = 0.02;

/// Appends the part of a triangle that lies before the eye.
void project(const Projection& projection, const std::array<Corner, 3>& corners, std::vector<Patch>& patches);

/// Weights of the corners at a sample.
struct Weights {
  float a = 0, b = 0, c = 0;
};

/// Weights at any x, y; negative outside. Nothing is to be divided by for a triangle without area: `valid` is false.
struct Plane {
  explicit Plane(const std::array<Vec3, 3>& at);
  Weights operator()(double x, double y) const {
    const double dx = x - origin.x(), dy = y - origin.y();
    const double b = bx * dx + by * dy, c = cx * dx + cy * dy;
    return {static_cast<float>(1 - b - c), static_cast<float>(b), static_cast<float>(c)};
  }
  Vec2 origin;
  double bx = 0, by = 0, cx = 0, cy = 0;
  bool valid = false;
};

/// Calls `visit(x, y, weights)` for every sample of the window whose centre the triangle covers, edges included.
template <class Visit>
void cover(const std::array<Vec3, 3>& at, const Window& window, Visit visit) {
  const Plane plane(at);
  if (!plane.valid) return;
  const auto range = [&](int k, int low, int high) {
    const double least = std::min({at[0][k], at[1][k], at[2][k]}), most = std::max({at[0][k], at[1][k], at[2][k]});
    const auto clamped = [&](double value) {
      return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
    };
    return std::pair{clamped(std::floor(least)), clamped(std::ceil(most) + 1)};
  };
  const auto [left, right] = range(0, window.left, window.right);
  const auto [top, bottom] = range(1, window.top, window.bottom);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const Weights w = plane(x + 0.5, y + 0.5);
      if (w.a >= 0 && w.b >= 0 && w.c >= 0) visit(x, y, w);
    }
  }
}

}  // namespace wunderlich::picture
