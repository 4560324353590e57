// Nothing goes into or through anything, in any shipped scene, at any recorded step: by trying everything, apart from
// the solvers' own searches. WUNDERLICH_WHOLE_SCENES=1 runs the scenes to their ends (the nightly script does).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "scene/placed.hpp"
#include "solver/paths.hpp"
#include "support/clearance.hpp"
#include "support/crossings.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::scene {
namespace {

constexpr int kAlong = 6, kAcross = 12;  // cells of a facet whose corners are tried

bool whole_scenes() { return std::getenv("WUNDERLICH_WHOLE_SCENES") != nullptr; }

/// Smallest signed distance of a facet's points to a solid.
double distance_to(const constraint::Obstacle& obstacle, double time, const solver::StripPlace& strip) {
  const Pose pose = constraint::pose_at(obstacle.motion, time);
  const auto& [ribbon, chain, k] = strip;
  double least = 1e9;
  for (std::size_t s = 0; s + 1 < k.r.size(); ++s) {
    for (int i = 0; i <= kAlong; ++i) {
      const double f = static_cast<double>(i) / kAlong, eta = (1 - f) * chain.eta[s] + f * chain.eta[s + 1];
      const Vec3 middle = k.r[s] + f * (k.r[s + 1] - k.r[s]);
      const Vec3 ruling = ribbon.width * (k.frame[s].col(1) + eta * k.frame[s].col(2));
      for (int j = 0; j <= kAcross; ++j) {
        const Vec3 point = middle + (static_cast<double>(j) / kAcross - 0.5) * ruling;
        least = std::min(least, contact::distance(obstacle.shape, pose, point).value);
      }
    }
  }
  return least;
}

/// Runs a scene with every step recorded; in short up to the time given, under sanitizers to a tenth of it.
void expect_clear(const std::string& name, double until, double allowed, std::vector<std::string> set = {}) {
  set.emplace_back("output.frames=2000");
  const double share = testing::is_slow_build() ? 0.1 : 1;
  if (!whole_scenes() && until > 0) set.push_back("solver.duration=" + std::to_string(share * until));
  const Scene scene = read_scene(name, set);
  const RunResult result = run(scene, nullptr);
  ASSERT_EQ(result.outcome, Outcome::converged) << result.summary.failure;
  ASSERT_GT(static_cast<int>(result.progress.records.size()), result.summary.steps) << "not every step was kept";
  const auto& obstacles = scene.surroundings.obstacles;
  ASSERT_TRUE(!obstacles.empty() || scene.surroundings.contact.self);
  Placed strips;
  const auto& [distance, thickness] =
      std::pair(scene.surroundings.contact.distance, scene.surroundings.contact.thickness);
  double least = 1e9;
  int touched = 0;
  for (const Record& record : result.progress.records) {
    place(scene, record, strips);
    double now = 1e9;
    for (const solver::StripPlace& strip : strips.places) {
      for (const auto& obstacle : obstacles) now = std::min(now, distance_to(obstacle, record.history.time, strip));
    }
    least = std::min(least, now);
    // What is nearer along the strip than its width need not touch.
    if (scene.surroundings.contact.self) now = std::min(now, testing::clearance(strips.places, scene.ribbon.width));
    // Forces begin at the distance beyond what points keep, half of it where rulings do not lean.
    touched += now < thickness + 1.5 * distance ? 1 : 0;
    if (!scene.surroundings.contact.self) continue;
    ASSERT_EQ(testing::crossings(strips.places), 0) << name << " at " << record.history.time;
  }
  std::printf("  %-16s %4zu records, smallest distance to a solid %.3g m, %d touch\n", name.c_str(),
              result.progress.records.size(), least, touched);
  // A slow build follows a scene for a moment only.
  if (!testing::is_slow_build()) {
    EXPECT_GT(touched, 0) << name << " touches nothing";
  }
  EXPECT_GT(least, thickness - allowed) << name;
  // What the run says of itself is a bound from below, of all steps.
  ASSERT_TRUE(result.summary.contact);
  EXPECT_LE(result.summary.contact->minimum_distance, least - thickness + 1e-9) << name;
}

TEST(Penetration, NoneInDrapeCylinder) { expect_clear("drape-cylinder", 0.8, 0); }
TEST(Penetration, NoneOfAThickStrip) { expect_clear("drape-cylinder", 0.3, 0, {"contact.thickness=2e-3"}); }
TEST(Penetration, NoneInBelt) { expect_clear("belt", 0.3, 0); }
TEST(Penetration, NoneInPile) { expect_clear("pile", 0.3, 0); }
TEST(Penetration, NoneInPaperChain) { expect_clear("paper-chain", 0.16, 0); }
TEST(Penetration, NoneInLoop) { expect_clear("loop-2pi", 0, 0); }
TEST(Penetration, NoneInKnot) { expect_clear("knot", 0.5, 0); }
TEST(Penetration, NoneInCoil) { expect_clear("coil", 0, 0); }

/// A hundredth of the width is what the two-stage method may.
TEST(Penetration, BelowAHundredthInSlideCylinder) {
  expect_clear("slide-cylinder", 0.25, 0.01 * read_scene("slide-cylinder").ribbon.width);
}

}  // namespace
}  // namespace wunderlich::scene
