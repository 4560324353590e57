#include "wunderlich/picture/raster.hpp"

namespace wunderlich::picture {

namespace {

Corner between(const Corner& p, const Corner& q, float t) {
  return {p.position + t * (q.position - p.position), p.normal + t * (q.normal - p.normal),
          p.colour + t * (q.colour - p.colour)};
}

Patch patch_of(const Projection& projection, const std::array<Corner, 3>& corners) {
  Patch patch{corners, {}, true};
  for (std::size_t k = 0; k < 3; ++k) {
    patch.at[k] = projection.sample(projection.eye_space(corners[k].position.cast<double>()));
  }
  const Vec3 p = patch.at[1] - patch.at[0], q = patch.at[2] - patch.at[0];
  patch.front = p.x() * q.y() - p.y() * q.x() < 0;  // y points down
  return patch;
}

}  // namespace

Projection::Projection(const Camera& from, int width, int height)
    : camera(from), scale(0.5 * height / from.half_height), centre(0.5 * width, 0.5 * height) {}

Vec3 Projection::eye_space(const Vec3& p) const {
  const Vec3 d = p - camera.eye;
  return {d.dot(camera.view.right), d.dot(camera.view.up), -d.dot(camera.view.towards)};
}

Vec3 Projection::sample(const Vec3& e) const {
  return {centre.x() + scale * e.x() / e.z(), centre.y() - scale * e.y() / e.z(), 1 / e.z()};
}

void project(const Projection& projection, const std::array<Corner, 3>& corners, std::vector<Patch>& patches) {
  std::array<double, 3> before{};  // the near plane
  bool all = true;
  for (std::size_t k = 0; k < 3; ++k) {
    before[k] = projection.eye_space(corners[k].position.cast<double>()).z() - near_plane;
    all = all && before[k] >= 0;
  }
  if (all) {
    patches.push_back(patch_of(projection, corners));
    return;
  }
  std::vector<Corner> kept;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (before[k] >= 0) kept.push_back(corners[k]);
    if ((before[k] >= 0) == (before[next] >= 0)) continue;
    kept.push_back(between(corners[k], corners[next], static_cast<float>(before[k] / (before[k] - before[next]))));
  }
  for (std::size_t k = 2; k < kept.size(); ++k) {
    patches.push_back(patch_of(projection, {kept[0], kept[k - 1], kept[k]}));
  }
}

Plane::Plane(const std::array<Vec3, 3>& at) : origin(at[0].head<2>()) {
  const Vec2 p = (at[1] - at[0]).head<2>(), q = (at[2] - at[0]).head<2>();
  const double area = p.x() * q.y() - p.y() * q.x();
  valid = std::abs(area) > 1e-12;
  if (!valid) return;
  bx = q.y() / area, by = -q.x() / area;
  cx = -p.y() / area, cy = p.x() / area;
}

}  // namespace wunderlich::picture
