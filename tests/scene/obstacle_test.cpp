/// Obstacles and contact in scene files: what is read, and what is refused with which words.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "messages.hpp"

namespace wunderlich::scene {
namespace {

constexpr double pi = std::numbers::pi;
const std::string strip = "ribbon: {length: 2, width: 0.6, segments: 4}\n";

Scene read(const std::string& text) { return read_scene_text(strip + text, "some.yaml"); }

template <typename T>
T shape_of(const Scene& scene, std::size_t index) {
  return std::get<T>(scene.surroundings.obstacles.at(index).shape);
}

Pose pose_of(const Scene& scene, std::size_t index, double time = 0) {
  return pose_at(scene.surroundings.obstacles.at(index).motion, time);
}

Vec3 axis_of(const Scene& scene, std::size_t index, double time = 0) {
  return pose_of(scene, index, time).frame * Vec3::UnitZ();
}

TEST(Obstacles, ShapesWithTheirSizes) {
  const Scene scene = read(R"(
obstacles:
  - {shape: plane}
  - {shape: sphere, radius: 0.1}
  - {shape: cylinder, radius: 0.2}
  - {shape: cylinder, radius: 0.2, length: 3}
  - {shape: capsule, radius: 0.3, length: 1}
  - {shape: box, size: [1, 2, 3]}
)");
  ASSERT_EQ(scene.surroundings.obstacles.size(), 6u);
  EXPECT_TRUE(std::holds_alternative<contact::HalfSpace>(scene.surroundings.obstacles[0].shape));
  EXPECT_EQ(shape_of<contact::Sphere>(scene, 1).radius, 0.1);
  EXPECT_TRUE(std::isinf(shape_of<contact::Cylinder>(scene, 2).half_length));
  EXPECT_EQ(shape_of<contact::Cylinder>(scene, 3).radius, 0.2);
  EXPECT_EQ(shape_of<contact::Cylinder>(scene, 3).half_length, 1.5);
  EXPECT_EQ(shape_of<contact::Capsule>(scene, 4).radius, 0.3);
  EXPECT_EQ(shape_of<contact::Capsule>(scene, 4).half_length, 0.5);
  EXPECT_EQ(shape_of<contact::Box>(scene, 5).half_size, Vec3(0.5, 1, 1.5));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(pose_of(scene, i).position, Vec3(0, 0, 0));
    EXPECT_TRUE(pose_of(scene, i).frame.isApprox(Quat::Identity(), 1e-15));
    EXPECT_EQ(scene.surroundings.obstacles[i].friction, 0);
  }
}

TEST(Obstacles, PlacesAndDirections) {
  const Scene scene = read(R"(
obstacles:
  - {shape: plane, position: [0, 0, -1], normal: [0, 3, 4]}
  - {shape: cylinder, radius: 1, axis: [0, -2, 0], turn: pi/2}
  - {shape: box, size: [1, 2, 3], axis: [0, 0, -1], side: [0, 5, 0]}
)");
  EXPECT_EQ(pose_of(scene, 0).position, Vec3(0, 0, -1));
  EXPECT_LT((axis_of(scene, 0) - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_LT((axis_of(scene, 1) - Vec3(0, -1, 0)).norm(), 1e-15);
  // The shortest way from z to -y is about x, which stays; the turn then takes it right-handed about -y to z.
  EXPECT_LT((pose_of(scene, 1).frame * Vec3::UnitX() - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((axis_of(scene, 2) - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((pose_of(scene, 2).frame * Vec3::UnitX() - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((pose_of(scene, 2).frame * Vec3::UnitY() - Vec3(1, 0, 0)).norm(), 1e-15);
}

TEST(Obstacles, KeyframesCarryOverAndSetTheDuration) {
  const Scene scene = read(R"(
obstacles:
  - shape: cylinder
    radius: 0.1
    position: [1, 0, 0]
    axis: [0, 1, 0]
    keyframes:
      - {time: 1}
      - {time: 2, position: [3, 0, 0]}
      - {time: 4, axis: [1, 0, 0], turn: 5pi}
  - {shape: box, size: [1, 1, 1], keyframes: [{time: 0}, {time: 1, side: [0, 1, 0]}]}
)");
  EXPECT_EQ(scene.solver.duration, 4);
  EXPECT_EQ(pose_of(scene, 0, 0).position, Vec3(1, 0, 0));
  EXPECT_LT((pose_of(scene, 0, 1.5).position - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(pose_of(scene, 0, 9).position, Vec3(3, 0, 0));
  EXPECT_LT((axis_of(scene, 0, 2) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((axis_of(scene, 0, 3) - Vec3(1, 1, 0).normalized()).norm(), 1e-15);
  EXPECT_LT((axis_of(scene, 0, 4) - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(scene.surroundings.obstacles[0].motion.keys.back().turn, 5 * pi);
  EXPECT_LT((pose_of(scene, 1, 1).frame * Vec3::UnitX() - Vec3(0, 1, 0)).norm(), 1e-15);
}

// What a solid's own keys say is where keyframes that omit it take it from, and no place it has at 0.
TEST(Obstacles, WithoutAKeyframeAtZeroStartAtTheirFirst) {
  const Scene scene = read(R"(
obstacles:
  - shape: sphere
    radius: 0.1
    position: [1, 0, 0]
    keyframes: [{time: 1, position: [3, 0, 0]}, {time: 2, position: [5, 0, 0]}]
)");
  EXPECT_EQ(pose_of(scene, 0, 0).position, Vec3(3, 0, 0));
  EXPECT_EQ(pose_of(scene, 0, 1).position, Vec3(3, 0, 0));
  EXPECT_LT((pose_of(scene, 0, 1.5).position - Vec3(4, 0, 0)).norm(), 1e-15);
}

// Where only the axis changes, the frame does so without a turn about it: from key to key it stays as near as it can.
TEST(Obstacles, ARoundBodyDoesNotTurnAboutItsAxisByItself) {
  const Scene scene = read(R"(
obstacles:
  - {shape: capsule, radius: 1, length: 1, keyframes: [{time: 0, axis: [1, 0, 0]}, {time: 1, axis: [0, 1, 0]}]}
)");
  EXPECT_NEAR(pose_of(scene, 0, 0).frame.angularDistance(pose_of(scene, 0, 1).frame), pi / 2, 1e-14);
}

TEST(Obstacles, FrictionDistanceAndThickness) {
  const Scene plain = read("obstacles: [{shape: plane}]");
  EXPECT_DOUBLE_EQ(plain.surroundings.contact.distance, 0.02);
  EXPECT_EQ(plain.surroundings.contact.thickness, 0);
  const Scene scene = read(
      "obstacles: [{shape: plane}, {shape: plane, friction: 0}]\n"
      "contact: {friction: 0.3, distance: 1e-3, thickness: 2e-4}");
  EXPECT_EQ(scene.surroundings.obstacles[0].friction, 0.3);
  EXPECT_EQ(scene.surroundings.obstacles[1].friction, 0);
  EXPECT_EQ(scene.surroundings.contact.distance, 1e-3);
  EXPECT_EQ(scene.surroundings.contact.thickness, 2e-4);
}

std::string refused(const std::string& obstacle) { return message_of(strip + "obstacles:\n  - {" + obstacle + "}\n"); }

TEST(BadObstacles, ShapesAndSizes) {
  expect_all(refused("radius: 1"), {"bad.yaml:3:5: obstacles.0.shape: is missing", "plane, sphere, cylinder"});
  expect_all(refused("shape: spere, radius: 1"), {"bad.yaml:3:13: obstacles.0.shape", "did you mean `sphere`?"});
  expect_all(refused("shape: sphere"), {"obstacles.0.radius: is missing", "1e-06 to 1e+09 m"});
  expect_all(refused("shape: capsule, radius: 1"), {"obstacles.0.length: is missing"});
  expect_all(refused("shape: box"), {"obstacles.0.size: is missing", "three numbers"});
  expect_all(refused("shape: sphere, radius: -1"), {"bad.yaml:3:29: obstacles.0.radius: `-1` is not allowed"});
  expect_all(refused("shape: sphere, radius: .nan"), {"obstacles.0.radius", "is not allowed"});
  expect_all(refused("shape: sphere, radius: big"), {"obstacles.0.radius: `big`", "must be a number"});
  expect_all(refused("shape: cylinder, radius: 1, length: 0"), {"obstacles.0.length: `0`"});
  expect_all(refused("shape: box, size: [1, 0, 1]"), {"obstacles.0.size.1: `0`"});
  expect_all(refused("shape: box, size: [1, 1]"), {"obstacles.0.size: a list of 2", "three numbers"});
  expect_all(refused("shape: plane, friction: -0.1"), {"obstacles.0.friction: `-0.1`"});
  expect_all(refused("shape: plane, radios: 1"), {"obstacles.0.radios: unknown key", "`radius`"});
  expect_all(message_of(strip + "obstacles: {shape: plane}"), {"obstacles: a map is not allowed; must be a list"});
  expect_all(message_of(strip + "obstacles: [plane]"),
             {"obstacles.0: `plane` is not allowed; must be a map with shape"});
}

TEST(BadObstacles, KeysThatTheShapeDoesNotHave) {
  expect_all(refused("shape: plane, radius: 1"),
             {"bad.yaml:3:28: obstacles.0.radius: has no effect with `shape: plane`"});
  expect_all(refused("shape: plane, axis: [0, 0, 1]"), {"obstacles.0.axis: has no effect"});
  expect_all(refused("shape: sphere, radius: 1, length: 1"), {"obstacles.0.length: has no effect"});
  expect_all(refused("shape: cylinder, radius: 1, size: [1, 1, 1]"), {"obstacles.0.size: has no effect"});
  expect_all(refused("shape: capsule, radius: 1, length: 1, normal: [0, 0, 1]"), {"obstacles.0.normal: has no effect"});
  expect_all(refused("shape: sphere, radius: 1, keyframes: [{time: 0, side: [0, 0, 1]}]"),
             {"obstacles.0.keyframes.0.side: has no effect with `shape: sphere`"});
}

TEST(BadObstacles, DirectionsAndKeyframes) {
  expect_all(refused("shape: plane, normal: [0, 0, 0]"), {"bad.yaml:3:28: obstacles.0.normal: is (nearly) zero"});
  expect_all(refused("shape: cylinder, radius: 1, axis: [0, 0, 0]"), {"obstacles.0.axis: is (nearly) zero"});
  expect_all(refused("shape: cylinder, radius: 1, axis: [0, .inf, 0]"), {"obstacles.0.axis.1"});
  expect_all(refused("shape: box, size: [1, 1, 1], axis: [1, 0, 1]"),
             {"obstacles.0: axis and side must be perpendicular", "45.0000 degrees", "a side that is not given"});
  const std::string floor = "shape: plane, keyframes: ";
  expect_all(refused(floor + "[{time: 1}, {time: 1}]"), {"obstacles.0.keyframes.1.time: 1 does not come after"});
  expect_all(refused(floor + "[{time: .nan}]"), {"obstacles.0.keyframes.0.time"});
  expect_all(refused(floor + "[{position: [0, 0, 1]}]"), {"obstacles.0.keyframes.0.time: is missing"});
  expect_all(refused(floor + "[{time: 0, friction: 1}]"), {"obstacles.0.keyframes.0.friction: unknown key"});
  expect_all(refused(floor + "[{time: 0}, {time: 1, normal: [0, 0, -1]}]"),
             {"obstacles.0.keyframes.1: the frame turns by half a turn", "about the normal"});
}

TEST(BadObstacles, Contact) {
  const std::string floor = strip + "obstacles: [{shape: plane}]\n";
  expect_all(message_of(floor + "contact: {distance: 0}"), {"bad.yaml:3:21: contact.distance: `0` is not allowed"});
  expect_all(message_of(floor + "contact: {thickness: -1e-3}"), {"contact.thickness: `-1e-3`"});
  expect_all(message_of(floor + "contact: {friction: -1}"), {"contact.friction: `-1`"});
  expect_all(message_of(floor + "contact: {distanse: 1}"), {"contact.distanse: unknown key", "`distance`"});
  expect_all(message_of(strip + "contact: {friction: 1}"),
             {"bad.yaml:2:10: contact: has no effect without `obstacles`"});
}

TEST(Obstacles, AllMethodsKnowThem) {
  const std::string floor = strip + "obstacles: [{shape: plane}]\n";
  EXPECT_EQ(message_of(floor + "solver: {method: two-stage}"), "accepted");
  EXPECT_EQ(message_of(floor + "solver: {method: implicit}"), "accepted");
  EXPECT_EQ(message_of(floor + "solver: {method: equilibrium}"), "accepted");
  EXPECT_EQ(message_of(floor + "contact: {self: true, friction: 0.2}\nsolver: {method: two-stage}"), "accepted");
}

}  // namespace
}  // namespace wunderlich::scene
