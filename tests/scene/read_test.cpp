#include "wunderlich/scene/read.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "wunderlich/base/error.hpp"

namespace wunderlich::scene {
namespace {

using constraint::Orientation;
constexpr double pi = std::numbers::pi;

Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_scene_text(text, "folder/some-name.yaml", overrides);
}

const std::string plain = "ribbon: {length: 2, width: 0.5, segments: 4}\n";

TEST(ReadScene, DefaultsOfTheTableAreThoseOfTheStructs) {
  const Scene scene = read("ribbon: {length: 1, width: 0.1}");
  const geometry::RibbonSpec ribbon;
  EXPECT_EQ(scene.ribbon.segments, ribbon.segments);
  EXPECT_EQ(scene.ribbon.bending_stiffness, ribbon.bending_stiffness);
  EXPECT_EQ(scene.ribbon.area_density, ribbon.area_density);
  EXPECT_EQ(scene.ribbon.closure, ribbon.closure);
  EXPECT_EQ(scene.ribbon.half_twists, ribbon.half_twists);
  EXPECT_EQ(scene.ribbon.free_rulings, ribbon.free_rulings);
  const SolverOptions solver;
  EXPECT_EQ(scene.solver.energy.elastic, solver.energy.elastic);
  EXPECT_EQ(scene.solver.energy.taylor_order, solver.energy.taylor_order);
  EXPECT_EQ(scene.solver.energy.strain, solver.energy.strain);
  EXPECT_EQ(scene.solver.loop_path, solver.loop_path);
  EXPECT_EQ(scene.solver.duration, solver.duration);
  EXPECT_EQ(scene.solver.steps, solver.steps);
  EXPECT_EQ(scene.solver.tolerance, solver.tolerance);
  EXPECT_EQ(scene.solver.max_iterations, solver.max_iterations);
  EXPECT_EQ(scene.solver.barrier, solver.barrier);
  const OutputOptions output;
  EXPECT_EQ(scene.output.frames, output.frames);
  EXPECT_EQ(scene.output.subdivision, output.subdivision);
  EXPECT_EQ(scene.output.across, output.across);
  EXPECT_EQ(scene.output.formats, output.formats);
}

TEST(ReadScene, NameTitleAndResolvedText) {
  const Scene scene = read("title: \"Two: parts\"\n" + plain, {"ribbon.segments=9"});
  EXPECT_EQ(scene.name, "some-name");
  EXPECT_EQ(scene.title, "Two: parts");
  const Scene again = read_scene_text(scene.resolved, "other.yaml");
  EXPECT_EQ(again.ribbon.segments, 9);
  EXPECT_EQ(again.resolved, scene.resolved);
}

TEST(ReadScene, RibbonFromMaterialConstants) {
  const Scene scene = read(
      "ribbon: {length: 1, aspect: 2pi, young_modulus: 2e9, thickness: 1e-4, poisson_ratio: 0.25, mass_density: 1200}");
  EXPECT_DOUBLE_EQ(scene.ribbon.width, 1 / (2 * pi));
  EXPECT_DOUBLE_EQ(scene.ribbon.bending_stiffness, 2e9 * 1e-12 / (12 * (1 - 0.0625)));
  EXPECT_DOUBLE_EQ(scene.ribbon.area_density, 0.12);
}

TEST(ReadScene, AspectAndWidthReplaceEachOtherInOverrides) {
  EXPECT_DOUBLE_EQ(read(plain, {"ribbon.aspect=8"}).ribbon.width, 0.25);
  EXPECT_DOUBLE_EQ(read("ribbon: {length: 2, aspect: 4}", {"ribbon.width=0.1"}).ribbon.width, 0.1);
}

TEST(ReadScene, SpacingClosureAndOptions) {
  const Scene scene = read(R"(
ribbon: {length: 1, width: 0.1, segments: 3, spacing: [1, 2, 1], closure: loop, half_twists: -1}
solver: {energy: truncated, taylor_order: 7, strain: printed, path: twist, duration: 3, tolerance: 1e-9,
         max_iterations: 99, barrier: 1e-3}
output: {frames: 5, subdivision: 2, across: 4, formats: [obj]}
)");
  EXPECT_EQ(scene.ribbon.spacing, (std::vector<double>{1, 2, 1}));
  EXPECT_EQ(scene.ribbon.closure, geometry::Closure::loop);
  EXPECT_EQ(scene.ribbon.half_twists, -1);
  EXPECT_EQ(scene.solver.energy.elastic, energy::Elastic::truncated);
  EXPECT_EQ(scene.solver.energy.taylor_order, 7);
  EXPECT_EQ(scene.solver.energy.strain, energy::StrainMeasure::printed);
  EXPECT_EQ(scene.solver.loop_path, LoopPath::twist);
  EXPECT_EQ(scene.solver.duration, 3);
  EXPECT_EQ(scene.solver.tolerance, 1e-9);
  EXPECT_EQ(scene.solver.max_iterations, 99);
  EXPECT_EQ(scene.solver.barrier, 1e-3);
  EXPECT_EQ(scene.output.frames, 5);
  EXPECT_EQ(scene.output.subdivision, 2);
  EXPECT_EQ(scene.output.across, 4);
  EXPECT_EQ(scene.output.formats, std::vector<std::string>{"obj"});
}

TEST(ReadScene, AClampStandsWhereTheUndeformedStripHasIt) {
  const Scene scene = read(plain + "clamps: [{at: start}, {at: end}]");
  EXPECT_EQ(scene.ribbon.clamped, (std::array<bool, 2>{true, true}));
  const auto& end = scene.surroundings.supports.at(1);
  EXPECT_EQ(end.node, 4);
  EXPECT_EQ(end.segment, -1);
  EXPECT_EQ(end.orientation, Orientation::full);
  const Pose pose = pose_at(end.motion, 0);
  EXPECT_TRUE(pose.position.isApprox(Vec3(2, 0, 0), 1e-15));
  Mat3 undeformed;
  undeformed << Vec3::UnitZ(), -Vec3::UnitY(), Vec3::UnitX();
  EXPECT_TRUE(pose.frame.toRotationMatrix().isApprox(undeformed, 1e-14));
}

TEST(ReadScene, ClampFramesTurnsAndKeyframesCarryOver) {
  const Scene scene = read(plain + R"(
clamps:
  - at: end
    free: [x]
    tangent: [0, 2, 0]
    normal: [0, 0, -3]
    turn: pi/2
    keyframes:
      - {time: 0}
      - {time: 1, position: [0, 1, 0]}
      - {time: 4, turn: 5pi}
)");
  const auto& clamp = scene.surroundings.supports.at(0);
  EXPECT_EQ(clamp.hold_position, (std::array<bool, 3>{false, true, true}));
  ASSERT_EQ(clamp.motion.keys.size(), 3u);
  EXPECT_EQ(clamp.motion.keys[2].turn, 5 * pi);
  EXPECT_TRUE(clamp.motion.keys[2].pose.position.isApprox(Vec3(0, 1, 0)));
  EXPECT_EQ(scene.solver.duration, 4);
  const Mat3 start = pose_at(clamp.motion, 0).frame.toRotationMatrix();
  EXPECT_TRUE(start.col(2).isApprox(Vec3::UnitY(), 1e-14));
  // Right-handed about +y by a quarter turn, -z goes to -x.
  EXPECT_TRUE(start.col(0).isApprox(-Vec3::UnitX(), 1e-14)) << start;
}

TEST(ReadScene, PlacesOnTheStrip) {
  const Scene scene = read(plain + R"(
clamps: [{at: {node: 0}}, {at: {segment: 2}, orientation: about-tangent, free: [x, y, z]}]
pins: [{at: {u: 0.6}}]
forces: [{at: {node: 4}, force: [1, 2, 3], frame: material}, {at: {u: 2}, torque: [0, 0, 1]}]
gravity: [0, 0, -9.81]
)");
  const auto& supports = scene.surroundings.supports;
  EXPECT_EQ(supports.at(0).segment, -1);
  EXPECT_EQ(supports.at(1).segment, 2);
  EXPECT_EQ(supports.at(1).node, 2);
  EXPECT_EQ(supports.at(1).orientation, Orientation::about_tangent);
  EXPECT_EQ(supports.at(2).node, 1);
  EXPECT_EQ(supports.at(2).orientation, Orientation::free);
  EXPECT_EQ(scene.surroundings.loads.at(0).node, 4);
  EXPECT_EQ(scene.surroundings.loads.at(0).frame, constraint::LoadFrame::material);
  EXPECT_EQ(load_at(scene.surroundings.loads.at(0), 7).force, Vec3(1, 2, 3));
  EXPECT_EQ(scene.surroundings.loads.at(1).node, 4);
  EXPECT_EQ(scene.surroundings.gravity, Vec3(0, 0, -9.81));
  // The torque on the free end gives it a frame of its own.
  EXPECT_EQ(scene.ribbon.clamped, (std::array<bool, 2>{true, true}));
}

TEST(ReadScene, AnEndThatKeepsItsTangentFreeHasAFrameOfItsOwn) {
  const Scene scene =
      read(plain + "clamps: [{at: start, orientation: about-tangent}, {at: end, orientation: about-tangent}]");
  EXPECT_EQ(scene.ribbon.clamped, (std::array<bool, 2>{true, true}));
  EXPECT_EQ(scene.surroundings.supports.at(0).segment, -1);
  EXPECT_EQ(scene.surroundings.supports.at(1).segment, -1);
  EXPECT_EQ(scene.surroundings.supports.at(1).node, 4);
}

TEST(ReadScene, SeveralRibbonsEachHaveTheirOwn) {
  const Scene scene = read(R"(
ribbons:
  - {name: first, length: 2, width: 0.5, segments: 4, clamps: [{at: start}], forces: [{at: end, force: [0, 0, 1]}]}
  - {length: 3, width: 0.1, segments: 6, initial: {position: [0, 1, 2], tangent: [0, 1, 0], velocity: [1, 0, 0]}}
gravity: [0, 0, -9.81]
obstacles: [{shape: plane, position: [0, 0, -1]}]
contact: {self: true, distance: 0.01}
)");
  const std::vector<const Scene*> strips = strips_of(scene);
  ASSERT_EQ(strips.size(), 2u);
  EXPECT_EQ(strips[0]->ribbon_name, "first");
  EXPECT_EQ(strips[1]->ribbon_name, "2");
  EXPECT_EQ(strips[0]->ribbon.segments, 4);
  EXPECT_EQ(strips[1]->ribbon.segments, 6);
  EXPECT_EQ(strips[0]->surroundings.supports.size(), 1u);
  EXPECT_EQ(strips[0]->surroundings.loads.size(), 1u);
  EXPECT_TRUE(strips[1]->surroundings.supports.empty());
  EXPECT_TRUE(strips[1]->surroundings.loads.empty());
  ASSERT_TRUE(strips[1]->initial.place);
  EXPECT_EQ(strips[1]->initial.place->position, Vec3(0, 1, 2));
  EXPECT_NEAR((strips[1]->initial.place->frame * Vec3::UnitZ() - Vec3::UnitY()).norm(), 0, 1e-15);
  EXPECT_EQ(strips[1]->initial.velocity, Vec3(1, 0, 0));
  for (const Scene* strip : strips) {  // what surrounds them is common
    EXPECT_EQ(strip->surroundings.gravity, Vec3(0, 0, -9.81));
    EXPECT_EQ(strip->surroundings.obstacles.size(), 1u);
    EXPECT_EQ(strip->surroundings.contact.distance, 0.01);
    EXPECT_TRUE(strip->surroundings.contact.self);
  }
  EXPECT_EQ(read(scene.resolved).beside.size(), 1u);
  EXPECT_EQ(read(scene.resolved, {"ribbons.1.segments=9"}).beside.front().ribbon.segments, 9);
}

TEST(ReadScene, ReadsAFile) {
  const auto path = std::filesystem::path(testing::TempDir()) / "wunderlich-read-test.yaml";
  std::ofstream(path) << "\xef\xbb\xbf" << plain;
  EXPECT_EQ(read_scene(path.string()).ribbon.segments, 4);
  EXPECT_EQ(read_scene(path.string()).name, "wunderlich-read-test");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace wunderlich::scene
