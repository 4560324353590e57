#include "wunderlich/picture/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace wunderlich::picture {

namespace {

constexpr double field_of_view = 32 * std::numbers::pi / 180;
constexpr double filled = 0.82;           // of the picture, at most
constexpr double usual_azimuth = 0.5;     // rad
constexpr double shadow_below = 0.05;     // room for it, of the radius
constexpr double follow_beyond = 1.7;     // times the radius of the last frame
constexpr double body_of_interest = 1.5;  // times the ribbon's radius

Fit fit_of(const std::vector<const std::vector<Vec3>*>& lists) {
  Eigen::AlignedBox3d box;
  for (const auto* points : lists) {
    for (const Vec3& p : *points) box.extend(p);
  }
  Fit fit{box.center(), 0, box.min().z()};
  for (const auto* points : lists) {
    for (const Vec3& p : *points) fit.radius = std::max(fit.radius, (p - fit.centre).norm());
  }
  if (!(fit.radius > 0)) fit.radius = 1;
  return fit;
}

/// How far the ribbon spreads over the picture, times how much of its surface is turned to the eye.
double score(const Mesh& surface, const View& view) {
  Vec2 mean = Vec2::Zero();
  Mat2 second = Mat2::Zero();
  double facing = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec2 p(surface.points[i].dot(view.right), surface.points[i].dot(view.up));
    mean += p;
    second += p * p.transpose();
    facing += std::abs(surface.normals[i].dot(view.towards));
  }
  const auto count = static_cast<double>(surface.points.size());
  mean /= count;
  const Mat2 spread = second / count - mean * mean.transpose();
  return std::sqrt(std::max(0.0, spread.determinant())) * (0.35 + facing / count);
}

}  // namespace

View view_from(const Direction& direction) {
  const double a = direction.azimuth, e = direction.elevation;
  View view;
  view.towards = Vec3(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
  view.right = Vec3(std::cos(a), std::sin(a), 0);
  view.up = view.towards.cross(view.right);
  return view;
}

View best_view(const Mesh& surface) {
  View best = view_from({usual_azimuth, 0.5});
  double most = 0;
  for (int k = 0; k < 48; ++k) {
    for (const double elevation : {0.3, 0.5, 0.7}) {
      const double turn = k * std::numbers::pi / 24;
      const View view = view_from({usual_azimuth + turn, elevation});
      const double value = score(surface, view) * (1 + 0.4 * std::cos(turn));
      if (value > most) {
        most = value;
        best = view;
      }
    }
  }
  return best;
}

std::vector<std::vector<Vec3>> shown_points(const std::vector<const Frame*>& frames, const std::vector<Body>& bodies,
                                            const std::vector<std::size_t>& indices) {
  std::vector<std::vector<Vec3>> shown;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<Vec3> points = frames[f]->surface.points;
    const double radius = fit_of({&points}).radius;
    for (const Body& body : bodies) {
      if (fit_of({&body.mesh.points}).radius > body_of_interest * radius) continue;
      const Pose& pose = body.poses[indices[f]];
      for (const Vec3& p : body.mesh.points) points.push_back(pose.position + pose.frame * p);
    }
    shown.push_back(std::move(points));
  }
  return shown;
}

std::vector<Fit> fits_of(const std::vector<std::vector<Vec3>>& points) {
  std::vector<const std::vector<Vec3>*> all;
  all.reserve(points.size());
  for (const auto& list : points) all.push_back(&list);
  const Fit whole = fit_of(all);
  if (whole.radius <= follow_beyond * fit_of({all.back()}).radius) return std::vector<Fit>(points.size(), whole);
  std::vector<Fit> fits;
  fits.reserve(points.size());
  for (const auto* list : all) fits.push_back(fit_of({list}));
  return fits;
}

Camera frame_all(const View& view, double aspect, const std::vector<std::vector<Vec3>>& points,
                 const std::vector<Fit>& fits) {
  Mat3 axes;
  axes << view.right.transpose(), view.up.transpose(), view.towards.transpose();
  Eigen::AlignedBox3d box;
  for (std::size_t f = 0; f < points.size(); ++f) {
    for (const Vec3& p : points[f]) box.extend(axes * fits[f].on_stage(p));
  }
  const double tall = filled * std::tan(0.5 * field_of_view), wide = tall * aspect;
  const double x = box.center().x(), y = box.center().y() - shadow_below;
  double distance = 0;
  for (std::size_t f = 0; f < points.size(); ++f) {
    for (const Vec3& p : points[f]) {
      const Vec3 q = axes * fits[f].on_stage(p);
      distance = std::max(distance, q.z() + std::max(std::abs(q.x() - x) / wide, std::abs(q.y() - y) / tall));
    }
  }
  return {view, view.right * x + view.up * y + view.towards * distance, tall / filled, aspect};
}

}  // namespace wunderlich::picture
