/// Distances to solids: against a search over their surfaces, derivatives against differences, and at points where the
/// nearest point is not unique.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "wunderlich/contact/shape.hpp"

namespace wunderlich::contact {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Part of a surface over the unit square; round ones go on where u, the angle, leaves it.
using Patch = std::function<Vec3(double, double)>;

struct Solid {
  std::string name;
  Shape shape;
  std::vector<Patch> surface;  ///< of what is infinite: all that the sampled points can be nearest to
};

Vec3 polar(double r, double angle, double z) { return {r * std::cos(angle), r * std::sin(angle), z}; }

Patch tube(double radius, double half_length) {
  return [=](double u, double v) { return polar(radius, 2 * EIGEN_PI * u, half_length * (2 * v - 1)); };
}

Patch disc(double radius, double z) {
  return [=](double u, double v) { return polar(radius * v, 2 * EIGEN_PI * u, z); };
}

Patch ball(double radius, double center) {
  return [=](double u, double v) {
    return polar(radius * std::sin(EIGEN_PI * v), 2 * EIGEN_PI * u, center + radius * std::cos(EIGEN_PI * v));
  };
}

std::vector<Patch> box_faces(const Vec3& half) {
  std::vector<Patch> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      faces.push_back([=](double u, double v) {
        Vec3 p;
        p[axis] = side * half[axis];
        p[(axis + 1) % 3] = half[(axis + 1) % 3] * (2 * std::clamp(u, 0.0, 1.0) - 1);
        p[(axis + 2) % 3] = half[(axis + 2) % 3] * (2 * v - 1);
        return p;
      });
    }
  }
  return faces;
}

std::vector<Solid> solids() {
  const Vec3 half(0.5, 0.8, 0.3);
  return {{"half space", HalfSpace{}, {[](double u, double v) { return Vec3(6 * u - 3, 6 * v - 3, 0); }}},
          {"sphere", Sphere{0.7}, {ball(0.7, 0)}},
          {"cylinder", Cylinder{0.6, 0.9}, {tube(0.6, 0.9), disc(0.6, 0.9), disc(0.6, -0.9)}},
          {"endless cylinder", Cylinder{0.6, kInfinite}, {tube(0.6, 3)}},
          {"capsule", Capsule{0.4, 0.8}, {tube(0.4, 0.8), ball(0.4, 0.8), ball(0.4, -0.8)}},
          {"box", Box{half}, box_faces(half)}};
}

/// Least distance to a patch: the best of a grid, again on ever smaller grids around it.
double searched_distance(const Patch& patch, const Vec3& point) {
  constexpr int cells = 24;
  double u = 0.5, v = 0.5, half = 0.5, best = kInfinite;
  for (int round = 0; round < 9; ++round) {
    const double u_mid = u, v_mid = v;
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        const double a = u_mid + half * (2.0 * i / cells - 1);
        const double b = std::clamp(v_mid + half * (2.0 * j / cells - 1), 0.0, 1.0);
        const double d = (patch(a, b) - point).norm();
        if (d < best) best = d, u = a, v = b;
      }
    }
    half *= 4.0 / cells;
  }
  return best;
}

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
  const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
  return {x, y, z};
}

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random), w = normal(random);
  return {random_point(random), Quat(w, x, y, z).normalized()};
}

Vec3 placed(const Pose& pose, const Vec3& point) { return pose.position + pose.frame * point; }

TEST(ShapeDistance, OutsideIsThatOfTheNearestPointOfTheSurface) {
  std::mt19937 random(1);
  for (const Solid& solid : solids()) {
    int outside = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose pose = random_pose(random);
      const Vec3 point = random_point(random);
      const Distance d = distance(solid.shape, pose, placed(pose, point));
      if (d.value <= 0) continue;
      ++outside;
      double searched = kInfinite;
      for (const Patch& patch : solid.surface) searched = std::min(searched, searched_distance(patch, point));
      EXPECT_NEAR(d.value, searched, 1e-9) << solid.name << " " << point.transpose();
    }
    EXPECT_GT(outside, 15) << solid.name;
  }
}

// No two points' distances differ by more than they are apart: continuous, also inside and across the surface. Every
// point of the surface has distance zero.
TEST(ShapeDistance, IsContinuousEverywhereAndZeroOnTheSurface) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const Solid& solid : solids()) {
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 a = random_point(random), b = a + 0.3 * unit(random) * random_point(random);
      const double at_a = distance(solid.shape, {}, a).value, at_b = distance(solid.shape, {}, b).value;
      inside += at_a < 0;
      EXPECT_LE(std::abs(at_a - at_b), (a - b).norm() * (1 + 1e-14)) << solid.name << " " << a.transpose();
    }
    EXPECT_GT(inside, 20) << solid.name;
  }
  for (const Solid& solid : solids()) {
    if (solid.name == "capsule") continue;  // halves of its balls lie inside
    for (const Patch& patch : solid.surface) {
      for (int i = 0; i < 50; ++i) {
        const double u = unit(random), v = unit(random);
        EXPECT_NEAR(distance(solid.shape, {}, patch(u, v)).value, 0, 1e-15) << solid.name;
      }
    }
  }
}

/// Largest relative errors of normal and Hessian against central differences, with the step h.
std::pair<double, double> difference_errors(const Shape& shape, const Pose& pose, const Vec3& point, double h) {
  const Distance d = distance(shape, pose, point);
  Vec3 gradient;
  Mat3 hessian;
  for (int axis = 0; axis < 3; ++axis) {
    const Distance after = distance(shape, pose, point + h * Vec3::Unit(axis));
    const Distance before = distance(shape, pose, point - h * Vec3::Unit(axis));
    gradient[axis] = (after.value - before.value) / (2 * h);
    hessian.col(axis) = (after.normal - before.normal) / (2 * h);
  }
  return {(gradient - d.normal).norm(), (hessian - d.hessian).norm() / (1 + d.hessian.squaredNorm())};
}

/// Whether another feature of the surface is the nearest one within a distance of about h.
bool near_kink(const Shape& shape, const Vec3& p, double h) {
  const auto close = [h](double a, double b) { return std::abs(std::abs(a) - b) < h; };
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vec3 beyond = p.cwiseAbs() - box->half_size;
    for (int i = 0; i < 3; ++i) {
      if (close(p[i], box->half_size[i]) || close(p[i], 0) || close(beyond[i] - beyond[(i + 1) % 3], 0)) return true;
    }
    return false;
  }
  const double r = p.head<2>().norm();
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const double side = r - cylinder->radius, end = std::abs(p.z()) - cylinder->half_length;
    return close(side, 0) || close(end, 0) || close(side - end, 0) || close(p.z(), 0) || r < h;
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return close(p.z(), capsule->half_length) || r < h;
  return p.norm() < h;
}

TEST(ShapeDistance, NormalAndHessianAreItsDerivatives) {
  std::mt19937 random(3);
  for (const Solid& solid : solids()) {
    int curved = 0;
    for (int i = 0; i < 400; ++i) {
      const Pose pose = random_pose(random);
      const Vec3 point = random_point(random);
      if (near_kink(solid.shape, point, 0.05)) continue;
      const Vec3 world = placed(pose, point);
      const auto [gradient, hessian] = difference_errors(solid.shape, pose, world, 1e-5);
      EXPECT_LT(gradient, 1e-7) << solid.name << " " << point.transpose();
      EXPECT_LT(hessian, 1e-6) << solid.name << " " << point.transpose();
      const Distance d = distance(solid.shape, pose, world);
      EXPECT_NEAR(d.normal.norm(), 1, 1e-14);
      EXPECT_LT((d.hessian * d.normal).norm(), 1e-13 * (1 + d.hessian.norm())) << solid.name;
      EXPECT_TRUE(d.hessian.isApprox(d.hessian.transpose(), 1e-15) || d.hessian.isZero(0));
      curved += !d.hessian.isZero(0);
    }
    EXPECT_GT(curved, solid.name == "half space" ? -1 : 30) << solid.name;
  }
}

TEST(ShapeDistance, MovesWithTheSolid) {
  std::mt19937 random(4);
  for (const Solid& solid : solids()) {
    for (int i = 0; i < 100; ++i) {
      const Pose move = random_pose(random);
      const Vec3 point = random_point(random);
      const Distance still = distance(solid.shape, {}, point);
      const Distance moved = distance(solid.shape, move, placed(move, point));
      const Mat3 rotation = move.frame.toRotationMatrix();
      EXPECT_NEAR(still.value, moved.value, 1e-14) << solid.name;
      if (near_kink(solid.shape, point, 1e-3)) continue;
      EXPECT_LT((rotation * still.normal - moved.normal).norm(), 1e-12) << solid.name;
      EXPECT_LT((rotation * still.hessian * rotation.transpose() - moved.hessian).norm(),
                1e-11 * (1 + still.hessian.squaredNorm()))
          << solid.name;
    }
  }
}

void expect_sound(const Solid& solid, const Vec3& point) {
  const Distance d = distance(solid.shape, {}, point);
  EXPECT_TRUE(std::isfinite(d.value)) << solid.name << " " << point.transpose();
  EXPECT_NEAR(d.normal.norm(), 1, 1e-14) << solid.name << " " << point.transpose();
  EXPECT_TRUE(d.hessian.allFinite()) << solid.name << " " << point.transpose();
}

// Centers, axes, rims, edges and corners, and points next to them by little, by less than rounding and by less than a
// square can hold.
TEST(ShapeDistance, IsFiniteWhereTheNearestPointIsNotUnique) {
  const std::vector<double> x{0, 0.4, 0.5, 0.6, 0.7}, y{0, 0.8}, z{0, -0.0, 0.3, 0.8, 0.9, -0.9, 1.2};
  const std::vector<double> off{0, 1e-9, -1e-17, 1e-40, 1e-170, -1e-200, 5e-324};
  for (const Solid& solid : solids()) {
    for (const double a : x) {
      for (const double b : y) {
        for (const double c : z) {
          for (const double e : off) {
            expect_sound(solid, {a + e, b, c});
            expect_sound(solid, {a, b + e, c - e});
            expect_sound(solid, {a + e, b - e, c + e});
          }
        }
      }
    }
  }
}

TEST(ShapeDistance, InsideIsNegative) {
  EXPECT_EQ(distance(HalfSpace{}, {}, {5, 5, -2}).value, -2);
  EXPECT_EQ(distance(Sphere{0.7}, {}, {0, 0, 0}).value, -0.7);
  EXPECT_EQ(distance(Cylinder{0.5, 2}, {}, {0, 0, 0}).value, -0.5);
  EXPECT_EQ(distance(Cylinder{3, 2}, {}, {0, 0, 0}).value, -2);
  EXPECT_EQ(distance(Cylinder{0.5, kInfinite}, {}, {0, 0, 7}).value, -0.5);
  EXPECT_EQ(distance(Capsule{0.5, 2}, {}, {0, 0, 2}).value, -0.5);
  EXPECT_EQ(distance(Box{{1, 2, 3}}, {}, {0.25, 0, 0}).value, -0.75);
}

}  // namespace
}  // namespace wunderlich::contact
