#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/schema.hpp"

namespace wunderlich::scene {
namespace {

constexpr double pi = std::numbers::pi;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(ShippedScenes, AreThoseOfTheContract) {
  std::set<std::string> names;
  for (const ShippedScene& scene : shipped_scenes()) names.insert(scene.name);
  for (const char* name : {"moebius",
                           "figure-eight",
                           "twist-pi",
                           "twist-clamped",
                           "cantilever",
                           "buckled-strip",
                           "ring",
                           "helix",
                           "swing",
                           "whip",
                           "drape-cylinder",
                           "slide-cylinder",
                           "loop-2pi",
                           "pile",
                           "knot",
                           "paper-chain",
                           "belt",
                           "belt-release-stiff",
                           "belt-release-soft",
                           "twist-release-stiff",
                           "twist-release-soft"}) {
    EXPECT_TRUE(names.count(name)) << name;
  }
}

TEST(ShippedScenes, AreAllValidAndStateTheirMethod) {
  for (const ShippedScene& shipped : shipped_scenes()) {
    const Scene scene = read_scene(shipped.name);
    EXPECT_EQ(scene.name, shipped.name);
    EXPECT_NE(scene.title, shipped.name) << "no title";
    EXPECT_NE(shipped.text.find("method:"), std::string::npos) << shipped.name;
    EXPECT_EQ(read_scene_text(scene.resolved, "again").resolved, scene.resolved);
  }
}

TEST(ShippedScenes, TheTextInTheLibraryIsTheFile) {
  for (const ShippedScene& shipped : shipped_scenes()) {
    EXPECT_EQ(shipped.text,
              contents(std::filesystem::path(WUNDERLICH_SOURCE_DIR) / "scenes" / (shipped.name + ".yaml")));
  }
}

TEST(ShippedScenes, HaveTheProportionsOfTheContract) {
  const Scene moebius = read_scene("moebius");
  EXPECT_NEAR(moebius.ribbon.length / moebius.ribbon.width, 5 * pi, 1e-12);
  EXPECT_EQ(moebius.ribbon.segments, 50);
  EXPECT_EQ(moebius.ribbon.half_twists, 1);
  EXPECT_NEAR(read_scene("moebius", {"ribbon.width=1.6"}).ribbon.width, 1.6, 0);
  const Scene twist = read_scene("twist-pi");
  EXPECT_NEAR(twist.ribbon.length / twist.ribbon.width, 2.5 * pi, 1e-12);
  EXPECT_EQ(twist.ribbon.segments, 35);
  const double tension = load_at(twist.surroundings.loads.at(0), 1).force.x();
  EXPECT_NEAR(tension, 100 * twist.ribbon.bending_stiffness / twist.ribbon.width, 1e-9);
  const Scene clamped = read_scene("twist-clamped");
  EXPECT_NEAR(clamped.ribbon.length / clamped.ribbon.width, 2.5 * pi, 1e-12);
  const auto& supports = clamped.surroundings.supports;
  const Pose start = pose_at(supports.at(0).motion, 1);
  const Pose end = pose_at(supports.at(1).motion, 1);
  EXPECT_NEAR((end.position - start.position).norm(), 0.8 * clamped.ribbon.length, 1e-12);
  EXPECT_NEAR(start.frame.angularDistance(end.frame), pi, 1e-7);
  const Scene cantilever = read_scene("cantilever");
  EXPECT_EQ(cantilever.surroundings.gravity, Vec3(0, 0, -5));
}

/// The reader promises that whatever once crashed a fuzzed reader stays an ordinary refusal or a valid scene.
TEST(Fuzz, FormerCrashersAreHandled) {
  int replayed = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(WUNDERLICH_SOURCE_DIR) / "tests/scene/crashers")) {
    const std::string text = contents(entry.path());
    try {
      const Scene scene = read_scene_text(text, entry.path().filename().string());
      EXPECT_EQ(read_scene_text(scene.resolved, "again").resolved, scene.resolved) << entry.path();
    } catch (const InputError& error) {
      EXPECT_GT(std::string(error.what()).size(), 10u);
    }
    ++replayed;
  }
  EXPECT_GT(replayed, 0);
}

TEST(SchemaMarkdown, ThePageInDocsIsUpToDate) {
  EXPECT_EQ(contents(std::filesystem::path(WUNDERLICH_SOURCE_DIR) / "docs/scene-format.md"), schema_markdown())
      << "write it anew with: build/release/wunderlich schema > docs/scene-format.md";
}

TEST(SchemaMarkdown, NamesEveryKey) {
  const std::string page = schema_markdown();
  for (const Key& key : keys()) {
    EXPECT_FALSE(key.doc.empty()) << key.path;
    const std::string leaf = key.path.substr(key.path.rfind('.') + 1);
    EXPECT_NE(page.find(leaf + "`"), std::string::npos) << key.path;
  }
}

}  // namespace
}  // namespace wunderlich::scene
