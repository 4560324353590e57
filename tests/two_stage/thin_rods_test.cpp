/// Thin rods against facets, by exact distances that are written apart from the solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "two_stage/drops.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kHalf = 0.1;  // of the rods' axes [m]

/// Distance of a point to a straight piece.
double to_piece(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + share * (b - a) - p).norm();
}

/// Distance of two straight pieces: of the lines, if their nearest points are on both, else of an end.
double between(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  double least = std::min({to_piece(a, c, d), to_piece(b, c, d), to_piece(c, a, b), to_piece(d, a, b)});
  const Vec3 u = b - a, v = d - c, normal = u.cross(v), way = c - a;
  const double square = normal.squaredNorm();
  if (square < 1e-20 * u.squaredNorm() * v.squaredNorm()) return least;
  const double s = way.cross(v).dot(normal) / square, t = way.cross(u).dot(normal) / square;
  if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, std::abs(way.dot(normal)) / std::sqrt(square));
  return least;
}

/// Distance of a straight piece to a triangle: 0 if it goes through, that of an end if the end is above or below it, or
/// that of an edge.
double to_triangle(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& corner) {
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  const auto above = [&](const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (normal.dot((corner[(k + 1) % 3] - corner[k]).cross(p - corner[k])) < 0) return false;
    }
    return true;
  };
  const double high = normal.dot(a - corner[0]), low = normal.dot(b - corner[0]);
  if (high * low < 0 && above(a + high / (high - low) * (b - a))) return 0;
  double least = 1e9;
  if (above(a)) least = std::min(least, std::abs(high));
  if (above(b)) least = std::min(least, std::abs(low));
  for (std::size_t k = 0; k < 3; ++k) least = std::min(least, between(a, b, corner[k], corner[(k + 1) % 3]));
  return least;
}

/// Smallest distance of all facets to the axis of the only solid. Edges follow frames to the parallel error only, so
/// that corners of a facet are in a plane to that only: it is cut into triangles in both ways.
double axis_distance(const Drop& d) {
  const geometry::State& shape = d.c.state.shape;
  const Pose pose = constraint::pose_at(d.surroundings.obstacles[0].motion, shape.time);
  const Vec3 half = pose.frame * Vec3(0, 0, kHalf);
  double least = 1e9;
  for (std::size_t s = 0; s < shape.q.size(); ++s) {
    const Mat3 frame = shape.q[s].toRotationMatrix();
    const auto at = [&](std::size_t node, double v) -> Vec3 {
      return shape.r[node] + v * kWidth * (frame.col(1) + shape.eta[node] * frame.col(2));
    };
    const std::array<Vec3, 4> corner{at(s, -0.5), at(s + 1, -0.5), at(s + 1, 0.5), at(s, 0.5)};
    for (std::size_t k = 0; k < 4; ++k) {
      least = std::min(least, to_triangle(pose.position - half, pose.position + half,
                                          {corner[k], corner[(k + 1) % 4], corner[(k + 2) % 4]}));
    }
  }
  return least;
}

/// A strip that falls on a rod.
struct Fall {
  double radius;
  int segments;
  double speed;  ///< downwards [m/s]
  Vec3 axis;     ///< of the rod
};

/// It is kept out at every step, what is reported is not more than the truth, and the rod stays below.
void check(const Fall& fall, const contact::Shape& shape) {
  SCOPED_TRACE(::testing::Message() << "radius " << fall.radius << ", " << fall.segments << " segments");
  const Pose pose{Vec3(0.143, 0, -0.03 - kHalf * fall.axis.z()),
                  math::shortest_rotation(Vec3::UnitZ(), fall.axis.normalized())};
  Drop d = drop(2e-5, fall.segments, {solid(shape, pose, 0.5)}, {0, 0, -kGravity});
  d.c.options.ode.damping_tangent = d.c.options.ode.damping_normal = 1;
  for (Vec3& v : d.c.state.shape.r_dot) v = Vec3(0, 0, -fall.speed);
  double least = 1e9, told = 1e9, most_lean = 0;
  const int steps = fall.speed > 0 ? 50 : 140;
  for (int k = 0; k < steps; ++k) {
    const two_stage::StepReport report = go(1e-3, 1e-3, 2, d);
    if (!report.accepted) break;
    told = std::min(told, report.nearest);
    least = std::min(least, axis_distance(d) - fall.radius);
  }
  for (const double eta : d.c.state.shape.eta) most_lean = std::max(most_lean, std::abs(eta));
  std::printf("  R %.1f mm, %2d segments, %.1f m/s: %.4f mm clear, %.4f told, lean %.2f, %d halvings\n",
              1e3 * fall.radius, fall.segments, fall.speed, 1e3 * least, 1e3 * told, most_lean, d.halvings);
  EXPECT_GT(least, 0);
  EXPECT_LT(least, d.surroundings.contact.distance);  // it got there
  EXPECT_LT(told, least + 1e-9);
  const auto middle = static_cast<std::size_t>(std::lround(0.143 / 0.3 * fall.segments));
  EXPECT_GT(d.c.state.shape.r[middle].z(), -0.05) << "the rod went through";
}

TEST(TwoStageThinRods, StayOutOfFacets) {
  for (const int segments : {6, 10}) {
    for (const double radius : {1e-4, 2e-4, 5e-4, 1e-3, 4e-3}) {
      check({radius, segments, 0, {0.3, 1, 0}}, contact::Capsule{radius, kHalf});
    }
  }
}

TEST(TwoStageThinRods, LeaningRulingsAreKeptOutToo) {
  for (const double radius : {1e-4, 2e-4, 5e-4, 1e-3})
    check({radius, 10, 0, {2, 1, 0}}, contact::Capsule{radius, kHalf});
}

TEST(TwoStageThinRods, EndsDoNotPierce) {
  for (const double radius : {1e-4, 1e-3}) {
    for (const double speed : {0.5, 2.0}) check({radius, 10, speed, {0, 0, 1}}, contact::Capsule{radius, kHalf});
  }
}

TEST(TwoStageThinRods, AreNotLeaptOver) {
  for (const double radius : {1e-4, 1e-3}) {
    for (const double speed : {1.0, 2.0, 3.0}) {
      check({radius, 10, speed, {0.3, 1, 0}}, contact::Capsule{radius, kHalf});
      check({radius, 10, speed, {0.3, 1, 0}}, contact::Cylinder{radius, kHalf});
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
