// Axes of a sweep: what they expand to, and what is refused.
#include "wunderlich/sweep/spec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wunderlich/base/error.hpp"

namespace wunderlich::sweep {
namespace {

std::string sweep_with(const std::string& axes) {
  return "scene: cantilever\naxes:\n" + axes + "collect: {energy: energy.normalized}\n";
}

Sweep read(const std::string& axes) { return read_sweep_text(sweep_with(axes), "test.yaml"); }

std::string message(const std::string& text) {
  try {
    read_sweep_text(text, "test.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Sweep, RunsAreAllCombinationsTheLastAxisFastest) {
  const Sweep sweep = read(
      "  - {key: ribbon.width, values: [0.1, 0.2]}\n"
      "  - {key: ribbon.segments, values: [10, 20, 30]}\n");
  ASSERT_EQ(run_count(sweep), 6u);
  EXPECT_EQ(assignments_of(sweep, 0), (std::vector<std::string>{"ribbon.width=0.1", "ribbon.segments=10"}));
  EXPECT_EQ(assignments_of(sweep, 4), (std::vector<std::string>{"ribbon.width=0.2", "ribbon.segments=20"}));
}

TEST(Sweep, RangesReachBothEnds) {
  const Sweep sweep = read(
      "  - {key: ribbon.width, linear: {from: 0.1, to: 0.3, count: 3}}\n"
      "  - {key: ribbon.bending_stiffness, log: {from: 1e-3, to: 10, count: 5}}\n");
  ASSERT_EQ(sweep.axes[0].points.size(), 3u);
  EXPECT_DOUBLE_EQ(sweep.axes[0].points[1].values[0], 0.2);
  EXPECT_EQ(sweep.axes[1].points.front().values[0], 1e-3);
  EXPECT_EQ(sweep.axes[1].points.back().values[0], 10);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(std::log10(sweep.axes[1].points[i].values[0]), -3.0 + static_cast<double>(i), 1e-12);
  }
}

TEST(Sweep, ZippedColumnsGoTogether) {
  const Sweep sweep = read(
      "  - zip:\n"
      "      - {name: w, key: ribbon.width, values: [0.1, 0.2]}\n"
      "      - {keys: [ribbon.length, ribbon.area_density], values: [1, 2]}\n");
  ASSERT_EQ(run_count(sweep), 2u);
  EXPECT_EQ(sweep.axes[0].columns, (std::vector<std::string>{"w", "ribbon.length"}));
  EXPECT_EQ(assignments_of(sweep, 1),
            (std::vector<std::string>{"ribbon.width=0.2", "ribbon.length=2", "ribbon.area_density=2"}));
}

TEST(Sweep, ALatinHypercubeHasOneSampleInEveryPart) {
  const Sweep sweep = read(
      "  - latin_hypercube:\n"
      "      count: 50\n"
      "      seed: 3\n"
      "      axes:\n"
      "        - {key: ribbon.width, from: 0.1, to: 0.2}\n"
      "        - {key: ribbon.bending_stiffness, from: 0.01, to: 100, scale: log}\n");
  ASSERT_EQ(run_count(sweep), 50u);
  std::set<int> first, second;
  std::vector<int> order;
  for (const AxisPoint& point : sweep.axes[0].points) {
    order.push_back(static_cast<int>((point.values[0] - 0.1) / 0.1 * 50));
    first.insert(order.back());
    second.insert(static_cast<int>((std::log10(point.values[1]) + 2) / 4 * 50));
  }
  EXPECT_EQ(first.size(), 50u);
  EXPECT_EQ(second.size(), 50u);
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
}

TEST(Sweep, SamplesDependOnTheSeedAlone) {
  const auto samples = [](int seed) {
    const Sweep sweep = read("  - random: {count: 20, seed: " + std::to_string(seed) +
                             ", axes: [{key: ribbon.width, from: 0.1, to: 0.2}]}\n");
    std::vector<std::string> words;
    for (const AxisPoint& point : sweep.axes[0].points) words.push_back(point.words[0]);
    return words;
  };
  EXPECT_EQ(samples(5), samples(5));
  EXPECT_NE(samples(5), samples(6));
}

TEST(Sweep, KeysTellRunsApartAndNothingElse) {
  const std::string axes = "  - {key: ribbon.width, values: [0.1, 0.2]}\n";
  const Sweep a = read(axes), b = read("  - {key: ribbon.width, values: [0.3, 0.2]}\n");
  EXPECT_NE(key_of(a, 0), key_of(a, 1));
  EXPECT_EQ(key_of(a, 1), key_of(b, 1));  // a longer or another axis keeps the runs it has in common
  Sweep other = a;
  other.scene_text += " ";
  EXPECT_NE(key_of(a, 0), key_of(other, 0));
}

TEST(Sweep, StandsAlone) {
  const Sweep sweep = read("  - {key: ribbon.width, values: [0.1, 0.2]}\n");
  const Sweep again = read_sweep_text(sweep.text, "elsewhere/sweep.yaml");
  EXPECT_EQ(again.name, "test");
  EXPECT_EQ(again.text, sweep.text);
  EXPECT_EQ(key_of(again, 1), key_of(sweep, 1));
}

TEST(Sweep, BadInputSaysWhereAndWhat) {
  const auto refused = [](const std::string& axes, const std::string& says) {
    const std::string text = message(sweep_with(axes));
    EXPECT_NE(text.find(says), std::string::npos) << axes << "\n" << text;
    EXPECT_EQ(text.compare(0, 10, "test.yaml:"), 0) << text;
  };
  refused("  - {key: ribbon.width, valus: [0.1]}\n", "did you mean `values`");
  refused("  - {key: ribbon.width, values: []}\n", "must be a list of 1");
  refused("  - {key: ribbon.width}\n", "must have one of");
  refused("  - {key: ribbon.width, keys: [a], values: [1]}\n", "must have `key` or `keys`");
  refused("  - {key: ribbon.width, values: [-1]}\n", "ribbon.width");
  refused("  - {key: ribbon.wdth, values: [1]}\n", "ribbon.wdth");
  refused("  - {key: ribbon.width, log: {from: 0, to: 1, count: 3}}\n", "axes.0.log.from");
  refused("  - {key: ribbon.width, values: [0.1]}\n  - {key: ribbon.width, values: [0.2]}\n", "twice");
  refused("  - zip: [{key: ribbon.width, values: [0.1]}, {key: ribbon.length, values: [1, 2]}]\n", "as many");
  refused("  - {random: {count: 2, seed: 1, axes: [{key: ribbon.width, from: 1, to: 2, scale: logg}]}}\n", "`log`");
  EXPECT_NE(message("scene: cantilver\naxes: []\ncollect: {}\n").find("cantilever"), std::string::npos);
  EXPECT_NE(message("scene: cantilever\naxes: [{key: ribbon.width, values: [1]}]\n").find("collect"),
            std::string::npos);
}

}  // namespace
}  // namespace wunderlich::sweep
