#include "wunderlich/constraint/support.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace wunderlich::constraint {
namespace {

constexpr double pi = std::numbers::pi;

PoseKey key(double time, const Vec3& position, const Quat& frame, double turn) {
  return {time, {position, frame}, turn};
}

TEST(PoseAt, IsConstantOutsideTheKeysAndExactAtThem) {
  const Quat a(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  const Quat b(Eigen::AngleAxisd(1.1, Vec3(-1, 0, 1).normalized()));
  const Motion motion{{key(1, Vec3(0.1, 0.2, 0.3), a, 0), key(3, Vec3(1, -1, 0.7), b, 0)}};
  for (const double t : {-5.0, 1.0}) {
    EXPECT_EQ(pose_at(motion, t).position, Vec3(0.1, 0.2, 0.3));
    EXPECT_LT(pose_at(motion, t).frame.angularDistance(a), 1e-15);
  }
  for (const double t : {3.0, 100.0}) {
    EXPECT_EQ(pose_at(motion, t).position, Vec3(1, -1, 0.7));
    EXPECT_LT(pose_at(motion, t).frame.angularDistance(b), 1e-15);
  }
  EXPECT_EQ(end_time(motion), 3);
}

TEST(PoseAt, MovesLinearlyAndTurnsTheShorterWay) {
  const Quat b(Eigen::AngleAxisd(1.0, Vec3::UnitY()));
  const Quat negated(-b.w(), -b.x(), -b.y(), -b.z());
  const Motion motion{{key(0, Vec3::Zero(), Quat::Identity(), 0), key(2, Vec3(4, 0, 0), negated, 0)}};
  const Pose quarter = pose_at(motion, 0.5);
  EXPECT_TRUE(quarter.position.isApprox(Vec3(1, 0, 0)));
  EXPECT_LT(quarter.frame.angularDistance(Quat(Eigen::AngleAxisd(0.25, Vec3::UnitY()))), 1e-7);
}

TEST(PoseAt, TurnsAboutTheTangentBeyondAFullTurn) {
  const Quat tilted(Eigen::AngleAxisd(0.7, Vec3::UnitX()));
  const Motion motion{{key(0, Vec3::Zero(), tilted, 0), key(1, Vec3::Zero(), tilted, 6 * pi)}};
  const Pose pose = pose_at(motion, 0.25);  // three quarters of a turn
  EXPECT_TRUE((pose.frame * Vec3::UnitZ()).isApprox(tilted * Vec3::UnitZ(), 1e-14));
  EXPECT_TRUE((pose.frame * Vec3::UnitX()).isApprox(tilted * -Vec3::UnitY(), 1e-14));
}

TEST(LoadAt, InterpolatesLinearly) {
  Load load;
  load.keys = {{1, Vec3(0, 0, 0), Vec3(2, 0, 0)}, {2, Vec3(0, 4, 0), Vec3(2, 0, 8)}};
  EXPECT_EQ(load_at(load, 0).force, Vec3::Zero());
  EXPECT_TRUE(load_at(load, 1.25).force.isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(load_at(load, 1.25).torque.isApprox(Vec3(2, 0, 2)));
  EXPECT_EQ(load_at(load, 9).torque, Vec3(2, 0, 8));
}

}  // namespace
}  // namespace wunderlich::constraint
