// Thickness of strips that touch themselves and one another: the certificate of the smallest distance, by trying all
// facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "scene/placed.hpp"
#include "solver/paths.hpp"
#include "support/clearance.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {
namespace {

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

/// Of all strips in one record, or of the last one with itself [m].
double clearance_at(const Scene& scene, const Record& record, bool only_last) {
  const double apart = 3 * (scene.surroundings.contact.distance + scene.surroundings.contact.thickness);
  Placed strips;
  place(scene, record, strips);
  return only_last ? testing::clearance({&strips.places.back(), 1}, apart) : testing::clearance(strips.places, apart);
}

/// What the run says of itself is a bound from below of all these records, and no more than a third of the distance at
/// which forces begin too careful.
void expect_confirmed(const Scene& scene, const ContactSummary& said, double found) {
  const auto& [distance, thickness] =
      std::pair(scene.surroundings.contact.distance, scene.surroundings.contact.thickness);
  std::printf("  said %.4g mm beyond the thickness, found %.4g mm\n", 1e3 * said.minimum_distance,
              1e3 * (found - thickness));
  EXPECT_GT(said.minimum_distance, 0);
  EXPECT_GE(found, thickness + said.minimum_distance - 1e-9);
  EXPECT_LE(found, thickness + said.minimum_distance + distance / 3);
}

/// At every step. `with_itself`: the last strip touches itself as well.
void expect_confirmed_motion(const char* text, bool with_itself) {
  const Scene scene = read_scene_text(text, "thick");
  const RunResult result = run(scene, nullptr);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.summary.failure;
  ASSERT_TRUE(result.summary.contact);
  ASSERT_GT(static_cast<int>(result.progress.records.size()), result.summary.steps);
  double least = 1, of_itself = 1;
  for (const Record& record : result.progress.records) {
    least = std::min(least, clearance_at(scene, record, false));
    if (with_itself) of_itself = std::min(of_itself, clearance_at(scene, record, true));
  }
  EXPECT_EQ(of_itself < scene.surroundings.contact.thickness + scene.surroundings.contact.distance, with_itself);
  expect_confirmed(scene, *result.summary.contact, least);
}

TEST(Thickness, IsKeptByAStripThatFoldsOnItself) {
  if (testing::is_slow_build()) GTEST_SKIP() << "150 steps of two strips take minutes here";
  expect_confirmed_motion(kFolding, true);
}

TEST(Thickness, IsKeptByAStripThatFallsOnAnother) { expect_confirmed_motion(kFalling, false); }

/// At rest, where its rims lie on each other; on the way there forces begin farther off.
TEST(Thickness, IsKeptByALoopAtRest) {
  const Scene scene = read_scene("loop-2pi", {"contact.thickness=4e-3"});
  const RunResult result = run(scene, nullptr);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.summary.failure;
  ASSERT_TRUE(result.summary.contact);
  expect_confirmed(scene, *result.summary.contact, clearance_at(scene, result.progress.records.back(), false));
}

}  // namespace
}  // namespace wunderlich::scene
