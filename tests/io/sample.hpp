/// A small run made by hand, and a folder of its own for each test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "geometry/chains.hpp"
#include "support/input_error.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/io/run_output.hpp"

namespace wunderlich::io::testing {

inline constexpr const char* report_template =
    "<!doctype html><script id=\"data\" type=\"application/json\">\"__WUNDERLICH_DATA__\"</script><p>end</p>";

/// Three instants of a strip that coils up.
inline RunOutput sample_run(int segments = 12) {
  geometry::RibbonSpec spec;
  spec.segments = segments;
  spec.width = 0.2;
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  const auto nodes = static_cast<std::size_t>(segments + 1);
  RunOutput out;
  geometry::State state;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> kappa(nodes, 0.0), eta(nodes, 0.0);
    for (std::size_t i = 1; i + 1 < nodes; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(segments);
      kappa[i] = 2.0 * k * std::cos(3 * t);
      eta[i] = 0.3 * k * std::sin(6 * t);
    }
    state = geometry::testing::hinged_chain(ribbon, kappa, eta);
    out.frames.push_back({0.5 * k, geometry::centerline(ribbon, state), geometry::render_mesh(ribbon, state, 2, 2)});
    HistoryRow row;
    row.time = 0.5 * k;
    row.energy = {0.1 * k, 0.25, -1.0 / 3, 1.5};
    row.constraints = {1e-15, 2e-15, 3e-15, 4e-15, 0.3};
    row.iterations = 3 + k;
    out.history.push_back(row);
  }
  out.patterns = {geometry::flat_pattern(ribbon, state)};
  out.title = "A strip that coils </script> up";
  out.summary.scene = "coil";
  out.summary.method = "equilibrium";
  out.summary.converged = true;
  out.summary.segments = segments;
  out.summary.energy = out.history.back().energy;
  out.summary.kappa_zeros = {0.5236, 0.75};
  out.summary.ends = {{Vec3(1, 2, 3), Vec3(4, 5, 6)}, {Vec3(-1, -2, -3), Vec3(0, 0.1, 0)}};
  out.summary.stability = Stability{true, 0};
  out.summary.timing.phases = {{"bend", 0.001}, {"settle", 0.002}};
  out.summary.warnings = {"a \"quoted\" warning"};
  out.parameters = {{"ribbon.width", "0.2 m"}};
  out.scene_text = "ribbon: {length: 1}\n";
  out.checkpoint.texts["scene"] = out.scene_text;
  out.checkpoint.arrays["eta"] = state.eta;
  out.report_template = report_template;
  return out;
}

class Folder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    root = std::filesystem::temp_directory_path() /
           (std::string("wunderlich-") + info->name() + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(root);
  }
  void TearDown() override { std::filesystem::remove_all(root); }

  /// Files and folders directly in `folder`, hidden ones too.
  static std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }
  std::filesystem::path root;
};

using wunderlich::testing::input_error;

}  // namespace wunderlich::io::testing
