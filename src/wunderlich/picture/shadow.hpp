/// Where the light comes from, and what it does not reach.
#pragma once

#include <vector>

#include "wunderlich/picture/raster.hpp"

namespace wunderlich::picture {

/// Towards the light, on the stage.
inline const Vec3 light = Vec3(1.6, -1.2, 3.4).normalized();

/// Depths seen from the light.
class Shadow {
 public:
  /// Of triangles on the stage, three points each.
  explicit Shadow(const std::vector<std::array<Vec3, 3>>& triangles);

  /// The share of the light that a point does not get, in [0, 1]: means over a square of (2 `reach` + 1)^2 places,
  /// `step` texels apart.
  float at(const Vec3& p, int reach, int step) const;

  /// Side of a texel, on the stage.
  double texel() const { return 1 / per_unit_; }

 private:
  Vec3 seen(const Vec3& p) const;  // texel x, y and height towards the light
  View axes_;
  double per_unit_ = 1;  // texels
  std::vector<float> height_;
};

}  // namespace wunderlich::picture
