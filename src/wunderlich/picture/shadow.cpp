#include "wunderlich/picture/shadow.hpp"

#include <limits>

namespace wunderlich::picture {

namespace {

constexpr int texels = 2048;
constexpr double least_half = 1, most_half = 2.5;  // of the lit square, on the stage
constexpr double bias = 0.004;                     // on the stage, along the light

View axes_of(const Vec3& towards) {
  const Vec3 right = Vec3::UnitZ().cross(towards).normalized();
  return {towards, right, towards.cross(right)};
}

}  // namespace

Shadow::Shadow(const std::vector<std::array<Vec3, 3>>& triangles)
    : axes_(axes_of(light)), height_(std::size_t{texels} * texels, std::numeric_limits<float>::lowest()) {
  double half = least_half;
  for (const auto& triangle : triangles) {
    for (const Vec3& p : triangle) half = std::max({half, std::abs(p.dot(axes_.right)), std::abs(p.dot(axes_.up))});
  }
  per_unit_ = 0.5 * texels / std::min(1.05 * half, most_half);
  for (const auto& triangle : triangles) {
    const std::array<Vec3, 3> at{seen(triangle[0]), seen(triangle[1]), seen(triangle[2])};
    cover(at, {0, 0, texels, texels}, [&](int x, int y, const Weights& w) {
      float& height = height_[static_cast<std::size_t>(y) * texels + static_cast<std::size_t>(x)];
      height = std::max(height, static_cast<float>(w.a * at[0].z() + w.b * at[1].z() + w.c * at[2].z()));
    });
  }
}

Vec3 Shadow::seen(const Vec3& p) const {
  return {0.5 * texels + per_unit_ * p.dot(axes_.right), 0.5 * texels + per_unit_ * p.dot(axes_.up),
          p.dot(axes_.towards)};
}

float Shadow::at(const Vec3& p, int reach, int step) const {
  const Vec3 here = seen(p);
  const int margin = reach * step + 1;
  const int x = static_cast<int>(std::clamp(here.x(), -1e6, 1e6)),
            y = static_cast<int>(std::clamp(here.y(), -1e6, 1e6));
  if (x < margin || y < margin || x >= texels - margin || y >= texels - margin) return 0;
  int dark = 0;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const auto texel = static_cast<std::size_t>(y + j * step) * texels + static_cast<std::size_t>(x + i * step);
      dark += height_[texel] > here.z() + bias ? 1 : 0;
    }
  }
  const int side = 2 * reach + 1;
  return static_cast<float>(dark) / static_cast<float>(side * side);
}

}  // namespace wunderlich::picture
