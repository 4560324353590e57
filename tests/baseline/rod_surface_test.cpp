// The strip that a rod spans: what twisting does to its area and its rims.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/rods.hpp"
#include "wunderlich/baseline/rod/surface.hpp"

namespace wunderlich::testing {
namespace {

geometry::RibbonSpec fig8_spec() {
  geometry::RibbonSpec spec;
  spec.width = 2 / (5 * kPi);
  spec.segments = 35;
  return spec;
}

/// The paper's Fig. 8: the far end slides along x under tension and turns.
PathEnd twisted_under_tension(const Rod& sample, double turn, double tension) {
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0),
                           clamp(35, {Vec3(1, 0, 0), straight_frame()}, Vec3(1, 0, 0), turn)};
  surroundings.supports[1].hold_position = {false, true, true};
  surroundings.loads = {{35, constraint::LoadFrame::space, {{0, Vec3(tension, 0, 0), Vec3::Zero()}}}};
  return along_path(sample, surroundings, rod::straight_state(sample), 20);
}

TEST(RodSurface, FlatStripIsFlat) {
  const Rod sample = rod::make_rod(fig8_spec(), rod::paper_ratio(fig8_spec()));
  const rod::State state = rod::straight_state(sample);
  EXPECT_NEAR(rod::area_change(sample, state), 0, 1e-14);
  EXPECT_NEAR(rod::rim_stretch(sample, state)[0], 0, 1e-14);
  const std::vector<Vec3> points = rod::surface_points(sample, state, 4);
  ASSERT_EQ(points.size(), 36u * 5);
  EXPECT_LE((points[5 * 9 + 2] - state.x[9]).norm(), 1e-15);
  EXPECT_LE((points[5 * 9 + 4] - state.x[9] - Vec3(0, -0.5 * sample.width, 0)).norm(), 1e-15);  // m2 = -y
  EXPECT_EQ(rod::surface_mesh(sample, state, 4).triangles.size(), 35u * 8);
}

// @eq Shen2015:6.5
TEST(RodSurface, TwistedUnderTensionItIsAHelicoid) {
  const Rod sample = rod::make_rod(fig8_spec(), rod::paper_ratio(fig8_spec()));
  for (double turn : {kPi, 2 * kPi}) {
    const PathEnd end = twisted_under_tension(sample, turn, 100 / sample.width);
    ASSERT_TRUE(end.done);
    // A uniform helicoid of this turn between the clamped edges, longer by what the tension stretches.
    const double twisted = 1 - 1.0 / 35, half = 0.5 * sample.width * turn / twisted;
    const double stretch = rod::largest_stretch(sample, end.state);
    const double rim = twisted * (std::sqrt(1 + half * half) - 1) + stretch;
    const double area = twisted * (0.5 * (std::sqrt(1 + half * half) + std::asinh(half) / half) - 1) + stretch;
    EXPECT_NEAR(stretch, 100 / sample.width / sample.stiffness.stretch, 1e-5);
    const auto rims = rod::rim_stretch(sample, end.state);
    EXPECT_NEAR(rod::area_change(sample, end.state), area, 0.03 * area);
    EXPECT_NEAR(rims[0], rim, 0.03 * rim);
    EXPECT_NEAR(rims[1], rims[0], 1e-6);
  }
}

TEST(RodSurface, TrianglesAreSeenFromTheSideOfTheirNormals) {
  const Rod sample = rod::make_rod(fig8_spec(), rod::paper_ratio(fig8_spec()));
  const Mesh mesh = rod::surface_mesh(sample, rod::straight_state(sample), 4);
  ASSERT_EQ(mesh.triangles.size(), 35u * 4 * 2);
  for (const auto& t : mesh.triangles) {
    const auto point = [&](int k) { return mesh.points[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
    const Vec3 normal = (point(1) - point(0)).cross(point(2) - point(0));
    EXPECT_GT(normal.dot(mesh.normals[static_cast<std::size_t>(t[0])]), 0);
  }
}

}  // namespace
}  // namespace wunderlich::testing
