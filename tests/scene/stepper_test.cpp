#include "wunderlich/scene/stepper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {
namespace {

using constraint::move_to;

Scene strip_by(const char* method, const char* more = "") {
  return read_scene_text(
      std::string("{ribbon: {length: 1, width: 0.1, segments: 20}, clamps: [{at: start, tangent: [1, 0, 0], normal: "
                  "[0, 0, 1]}], gravity: [0, 0, -1], solver: {method: ") +
          method + ", time_step: 0.01, duration: 0.1}" + more + "}",
      "strip");
}

class EitherMethod : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Stepper, EitherMethod, testing::Values("implicit", "two-stage"));

double distance(const geometry::State& a, const geometry::State& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.r.size(); ++i) most = std::max(most, (a.r[i] - b.r[i]).norm());
  return most;
}

TEST_P(EitherMethod, StepsAreThoseOfARunAndResetBeginsAnew) {
  Stepper stepper(strip_by(GetParam()));
  const geometry::State start = stepper.states().front();
  const RunResult whole = run(stepper.scene(), {});
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(stepper.step()) << stepper.failure();
    EXPECT_DOUBLE_EQ(stepper.time(), 0.1);
    EXPECT_LT(distance(stepper.states().front(), whole.progress.records.back().states.front()), 1e-14);
    EXPECT_GT(distance(stepper.states().front(), start), 1e-3);
    stepper.reset();
    EXPECT_EQ(stepper.time(), 0);
    EXPECT_EQ(distance(stepper.states().front(), start), 0);
  }
}

// What is told while it moves is what a scene says that knew it from the start.
TEST_P(EitherMethod, ChangesAreThoseOfAScene) {
  Scene foretold = strip_by(GetParam());
  const constraint::PoseKey before{0.05, foretold.surroundings.supports[0].motion.keys.front().pose, 0};
  constraint::PoseKey target = before;
  target.time = 0.1;
  target.pose.position = Vec3(0, 0.02, 0);
  target.turn = 0.3;
  foretold.surroundings.supports[0].motion.keys = {before, target};
  Stepper stepper(strip_by(GetParam())), known(foretold);
  for (int i = 0; i < 10; ++i) {
    if (i == 5) {
      constraint::Surroundings surroundings = stepper.scene().surroundings;
      move_to(target, stepper.time(), surroundings.supports[0].motion);
      stepper.change(0, surroundings);
    }
    ASSERT_TRUE(stepper.step()) << stepper.failure();
    ASSERT_TRUE(known.step()) << known.failure();
  }
  EXPECT_LT(distance(stepper.states().front(), known.states().front()), 1e-12);
  EXPECT_NEAR(stepper.states().front().r.front().y(), 0.02, 1e-12);
}

// A free fall, from the equation of motion: h g t^2 / 2 below, whatever held it before.
TEST_P(EitherMethod, WithoutSupportsAStripFallsWithTheGravityThatItIsGiven) {
  Stepper stepper(strip_by(GetParam()));
  constraint::Surroundings surroundings = stepper.scene().surroundings;
  surroundings.supports.clear();
  stepper.change(0, surroundings);
  surroundings.gravity = Vec3(0, 4, 0);
  stepper.change(0, surroundings);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(stepper.step()) << stepper.failure();
  // Semi-implicit Euler, which the two-stage method is, falls up to g t h / 2 further.
  const double further = GetParam() == std::string("implicit") ? 1e-8 : 0.5 * 4 * 0.1 * 0.01 + 1e-9;
  for (const Vec3& r : stepper.states().front().r) EXPECT_NEAR(r.y(), 0.5 * 4 * 0.01, further);
  EXPECT_NEAR(stepper.states().front().r_dot[7].y(), 0.4, 1e-6);
  EXPECT_NEAR(stepper.states().front().r_dot[7].z(), 0, 1e-6);
}

TEST_P(EitherMethod, ANodeCanBeGrabbedAndLetGo) {
  Stepper stepper(strip_by(GetParam()));
  constraint::Surroundings surroundings = stepper.scene().surroundings;
  constraint::Support pin;
  pin.node = 20;
  pin.orientation = constraint::Orientation::free;
  const Vec3 tip = stepper.states().front().r[20];
  pin.motion.keys = {{0, {tip, Quat::Identity()}, 0}};
  move_to({0.05, {tip + Vec3(-0.1, 0, 0.05), Quat::Identity()}, 0}, 0, pin.motion);
  surroundings.supports.push_back(pin);
  stepper.change(0, surroundings);
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(stepper.step()) << stepper.failure();
  EXPECT_LT((stepper.states().front().r[20] - tip - Vec3(-0.1, 0, 0.05)).norm(), 1e-6);
  surroundings.supports.pop_back();
  stepper.change(0, surroundings);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper.step()) << stepper.failure();
  EXPECT_GT((stepper.states().front().r[20] - tip - Vec3(-0.1, 0, 0.05)).norm(), 1e-3);
}

TEST(Stepper, GoesOnFromGivenStates) {
  const Scene scene = strip_by("implicit");
  Stepper first(scene);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(first.step());
  Stepper second(strip_by("implicit", ", output: {frames: 2}"), first.states());
  EXPECT_EQ(second.time(), 0);
  EXPECT_LT(distance(second.states().front(), first.states().front()), 1e-14);
  EXPECT_NEAR(second.history().energy.elastic, first.history().energy.elastic, 1e-12);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(first.step() && second.step());
  EXPECT_LT(distance(second.states().front(), first.states().front()), 1e-3);  // accelerations were found anew
  EXPECT_THROW(Stepper(read_scene("swing"), first.states()), InputError);
}

TEST(Stepper, AFailureLeavesTheLastGoodStateAndCanBePutRight) {
  Stepper stepper(strip_by("implicit"));
  ASSERT_TRUE(stepper.step());
  const constraint::Surroundings good = stepper.scene().surroundings;
  constraint::Surroundings bad = good;
  constraint::Support pin;  // further from the clamp than the strip is long
  pin.node = 20;
  pin.orientation = constraint::Orientation::free;
  pin.motion.keys = {{0, {Vec3(3, 0, 0), Quat::Identity()}, 0}};
  bad.supports.push_back(pin);
  stepper.change(0, bad);
  EXPECT_FALSE(stepper.step());
  EXPECT_FALSE(stepper.failure().empty());
  EXPECT_LT(stepper.history().constraints.max_length_error, 1e-12);
  stepper.change(0, good);
  EXPECT_TRUE(stepper.step()) << stepper.failure();
  EXPECT_TRUE(stepper.failure().empty());
}

TEST(Stepper, FrameIsThatOfARun) {
  Stepper stepper(strip_by("implicit"));
  const Frame frame = stepper.frame();
  EXPECT_EQ(frame.centerline.size(), 21u);
  EXPECT_EQ(frame.surface.points.size(), frame_of(stepper.scene(), {stepper.states(), {}}).surface.points.size());
  EXPECT_THROW(Stepper(read_scene("moebius")), InputError);
}

}  // namespace
}  // namespace wunderlich::scene
