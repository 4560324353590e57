/// shortest_rotation: takes one direction to the other by the smallest angle, also near a half turn.
#include <gtest/gtest.h>

#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::math {
namespace {

const Vec3 kFrom = Vec3(0.36, -0.48, 0.8);
const Vec3 kSquare = Vec3(0.8, 0.6, 0).normalized();

/// `kFrom` turned by `angle` towards `kSquare`.
Vec3 turned(double angle) { return std::cos(angle) * kFrom + std::sin(angle) * kSquare; }

// The rotation vector is known in closed form: the angle about from x square. The axis is as uncertain as the direction
// of from + to, of length 2 cos(angle/2), from its rounding.
TEST(ShortestRotation, TurnsByTheAngleBetweenAboutTheCommonNormal) {
  const Vec3 axis = kFrom.cross(kSquare);
  for (const double angle : {0.0, 1e-9, 0.3, 1.5, 2.5, 3.0, 3.14}) {
    const Quat q = shortest_rotation(kFrom, turned(angle));
    EXPECT_LT((log_map(q) - angle * axis).norm(), 1e-15 + 1e-15 * angle / std::cos(0.5 * angle)) << angle;
    EXPECT_NEAR(q.norm(), 1, 1e-15) << angle;
  }
}

// 1 - cos cancels here: a formula built on 1 + from . to loses half of the digits.
TEST(ShortestRotation, KeepsItsDigitsNearAHalfTurn) {
  for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const Vec3 to = -std::cos(gap) * kFrom + std::sin(gap) * kSquare;
    const Quat q = shortest_rotation(kFrom, to);
    EXPECT_LT((q * kFrom - to).norm(), 2e-15) << gap;
    EXPECT_NEAR(q.w(), std::sin(0.5 * gap), 1e-15) << gap;
  }
}

TEST(ShortestRotation, OfOppositeVectorsIsAHalfTurnSquareToThem) {
  for (const Vec3& from : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()), kFrom}) {
    const Quat q = shortest_rotation(from, -from);
    EXPECT_LT((q * from + from).norm(), 1e-15);
    EXPECT_LT(std::abs(q.w()), 1e-15);
    EXPECT_LT(std::abs(q.vec().dot(from)), 1e-15);
  }
}

}  // namespace
}  // namespace wunderlich::math
