// Thickness of strips that touch themselves and one another: the certificate of the smallest distance, by trying all
// facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "support/clearance.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/recording.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {
namespace {

constexpr double kReach = 5e-4, kThickness = 4e-4;  // m, of all scenes here

/// It falls on end and folds, on a broad strip for a floor.
const char* const kFolding = R"(
ribbons:
  - {name: floor, length: 0.4, width: 0.3, segments: 4, bending_stiffness: 1e-2, area_density: 0.2,
     clamps: [{at: start, position: [-0.2, 0, 0], tangent: [1, 0, 0], normal: [0, 0, 1]},
              {at: end, position: [0.1999, 0, 0], tangent: [1, 0, 0], normal: [0, 0, 1]}]}
  - {name: falls, length: 0.3, width: 0.03, segments: 24, bending_stiffness: 2e-5, area_density: 0.2,
     clamps: [{at: start, position: [0, 0, 0.302], tangent: [0, 0.02, -1], normal: [0, 1, 0.02], release: 0.01}]}
gravity: [0, 0, -9.81]
contact: {self: true, friction: 0.3, distance: 5e-4, thickness: 4e-4}
solver: {method: implicit, time_step: 2e-3, duration: 0.3}
output: {frames: 2000}
)";

/// One is held, the other falls across it and hangs over its rims.
const char* const kFalling = R"(
ribbons:
  - {name: held, length: 0.2, width: 0.03, segments: 12, bending_stiffness: 1e-2, area_density: 0.2,
     clamps: [{at: start, position: [-0.1, 0, 0], tangent: [1, 0, 0], normal: [0, 0, 1]},
              {at: end, position: [0.0999, 0, 0], tangent: [1, 0, 0], normal: [0, 0, 1]}]}
  - {name: falls, length: 0.2, width: 0.03, segments: 16, bending_stiffness: 2e-5, area_density: 0.2,
     initial: {position: [0.007, -0.1, 0.03], tangent: [0.2, 1, 0], normal: [0, 0, 1]}}
gravity: [0, 0, -9.81]
contact: {self: true, distance: 5e-4, thickness: 4e-4}
solver: {method: implicit, time_step: 2e-3, duration: 0.18}
output: {frames: 2000}
)";

/// What the run says of itself is a bound from below of every step, and no more than a third of the reach too careful.
/// `with_itself`: the last strip touches itself as well.
void expect_confirmed(const char* text, bool with_itself) {
  const Scene scene = read_scene_text(text, "thick");
  const RunResult result = run(scene, nullptr);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.summary.failure;
  ASSERT_TRUE(result.summary.contact);
  const std::vector<const Scene*> scenes = strips_of(scene);
  double least = 1, of_itself = 1;
  for (const Record& record : result.progress.records) {
    std::vector<geometry::Ribbon> ribbons;
    std::vector<geometry::Chain> chains;
    std::vector<geometry::Kinematics> kinematics(scenes.size());
    std::vector<solver::StripPlace> strips;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      ribbons.push_back(motion_ribbon(*scenes[i], record.states[i].time));
      chains.push_back(geometry::chain_of(ribbons[i], record.states[i]));
      geometry::forward_kinematics(ribbons[i], chains[i], kinematics[i]);
    }
    for (std::size_t i = 0; i < scenes.size(); ++i) strips.push_back({ribbons[i], chains[i], kinematics[i]});
    least = std::min(least, testing::clearance(strips, 3 * (kReach + kThickness)));
    if (with_itself)
      of_itself = std::min(of_itself, testing::clearance({&strips.back(), 1}, 3 * (kReach + kThickness)));
  }
  const double said = result.summary.contact->minimum_distance;
  std::printf("  %zu records, said %.4g mm beyond the thickness, found %.4g mm\n", result.progress.records.size(),
              1e3 * said, 1e3 * (least - kThickness));
  EXPECT_EQ(of_itself < kThickness + kReach, with_itself);
  EXPECT_GT(said, 0);
  EXPECT_GE(least, kThickness + said - 1e-9);
  EXPECT_LE(least, kThickness + said + kReach / 3);
}

TEST(Thickness, IsKeptByAStripThatFoldsOnItself) { expect_confirmed(kFolding, true); }
TEST(Thickness, IsKeptByAStripThatFallsOnAnother) { expect_confirmed(kFalling, false); }

}  // namespace
}  // namespace wunderlich::scene
