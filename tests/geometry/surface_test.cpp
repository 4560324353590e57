#include "wunderlich/geometry/surface.hpp"

#include <gtest/gtest.h>

#include "geometry/chains.hpp"

namespace wunderlich::geometry {
namespace {

using testing::hinged_chain;
using testing::random_strains;

Ribbon strip(int segments, double length = 2.0, double width = 0.3) {
  RibbonSpec spec;
  spec.segments = segments;
  spec.length = length;
  spec.width = width;
  return make_ribbon(spec);
}

TEST(SurfaceArea, OfAStraightStripIsLengthTimesWidth) {
  const Ribbon ribbon = strip(7);
  EXPECT_NEAR(surface_area(ribbon, straight_state(ribbon)), 0.6, 1e-15);
  EXPECT_LE(area_error(ribbon, straight_state(ribbon)), 1e-15);
}

// @eq Shen2015:6.1
TEST(SurfaceArea, OfAnyHingedChainIsExact) {
  RibbonSpec spec;
  spec.segments = 40;
  spec.width = 0.25;
  for (unsigned seed = 0; seed < 20; ++seed) {
    spec.spacing.clear();
    if (seed % 2 == 1) {
      for (int s = 0; s < spec.segments; ++s) spec.spacing.push_back(1 + 0.5 * std::sin(s));
    }
    const Ribbon ribbon = make_ribbon(spec);
    const auto [kappa, eta] = random_strains(ribbon, 0.99, seed);
    const State state = hinged_chain(ribbon, kappa, eta);
    const Strains strain = strains(ribbon, state);
    double largest = 0;
    for (double x : strain.ruling_ratio) largest = std::max(largest, std::abs(x));
    ASSERT_GT(largest, 0.3) << "the chain is nearly flat: the test would say nothing";
    ASSERT_LT(largest, 1.0);
    EXPECT_LE(area_error(ribbon, state), 1e-12) << "seed " << seed;
  }
}

TEST(SurfaceArea, SeesAStretchedSegment) {
  const Ribbon ribbon = strip(10);
  State state = straight_state(ribbon);
  for (Vec3& r : state.r) r *= 1.01;
  EXPECT_NEAR(area_error(ribbon, state), 0.01, 1e-12);
}

TEST(SurfaceArea, SeesShearBetweenRulingAndCenterline) {
  const Ribbon ribbon = strip(10);
  State state = straight_state(ribbon);
  for (Quat& q : state.q) q = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitZ())) * q;
  EXPECT_NEAR(area_error(ribbon, state), 1 - std::cos(0.1), 1e-12);
}

TEST(SurfaceArea, IsTwoTrianglesWhereRulingsMeet) {
  const Ribbon ribbon = strip(3, 0.3, 0.2);
  State state = straight_state(ribbon);
  state.eta[2] = 2.5;  // x = 0.1 * 2.5 / 0.1 = 2.5 on segment 1, -2.5 on segment 2
  const double l = 0.1, x = 2.5;
  const double bow_tie = 0.2 * l * 0.5 * (x + 1 / x);
  EXPECT_NEAR(surface_area(ribbon, state), 0.2 * l + 2 * bow_tie, 1e-14);
}

// @eq Shen2015:2
TEST(SurfaceArea, IsContinuousWhereRulingsBeginToMeet) {
  const Ribbon ribbon = strip(2, 0.2, 0.2);
  State below = straight_state(ribbon), above = below;
  below.eta[1] = 1 - 1e-9;
  above.eta[1] = 1 + 1e-9;
  EXPECT_NEAR(surface_area(ribbon, below), surface_area(ribbon, above), 1e-9);
}

// @eq Shen2015:1, Shen2015:6.1
TEST(RenderMesh, PassesThroughTheNodesAndKeepsTheRulings) {
  const Ribbon ribbon = strip(12);
  const auto [kappa, eta] = random_strains(ribbon, 0.5, 3);
  const State state = hinged_chain(ribbon, kappa, eta);
  const int subdivision = 3, across = 4;
  const Mesh mesh = render_mesh(ribbon, state, subdivision, across);
  ASSERT_EQ(mesh.points.size(), (12 * 3 + 1) * 5u);
  ASSERT_EQ(mesh.triangles.size(), 12 * 3 * 4 * 2u);
  for (std::size_t i = 0; i < state.r.size(); ++i) {
    const std::size_t first = i * 3 * 5;
    EXPECT_NEAR((mesh.points[first + 2] - state.r[i]).norm(), 0, 1e-14);
    const Mat3 frame = node_frame(ribbon, state, static_cast<int>(i)).toRotationMatrix();
    const Vec3 ruling = frame.col(1) + eta[i] * frame.col(2);
    EXPECT_NEAR((mesh.points[first + 4] - mesh.points[first] - ribbon.width * ruling).norm(), 0, 1e-14);
    EXPECT_NEAR((mesh.normals[first] - frame.col(0)).norm(), 0, 1e-14);
  }
}

TEST(RenderMesh, IsFourthOrderOnARing) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int n = k == 0 ? 20 : 40;
    const Ribbon ribbon = strip(n, 2 * std::numbers::pi, 0.3);
    const State state = hinged_chain(ribbon, std::vector<double>(n + 1, 1.0), std::vector<double>(n + 1, 0.0));
    // Nodes of a regular polygon lie on one circle, of radius l / (2 sin(l/2)).
    const double l = 2 * std::numbers::pi / n, radius = 0.5 * l / std::sin(0.5 * l);
    const Vec3 centre = state.r[1] + radius * (node_frame(ribbon, state, 1) * Vec3::UnitX());
    const Mesh mesh = render_mesh(ribbon, state, 4, 2);
    error[k] = 0;
    for (std::size_t a = 4; a <= 8; ++a) {
      error[k] = std::max(error[k], std::abs((mesh.points[3 * a + 1] - centre).norm() - radius));
    }
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_GT(error[0], 0);
  EXPECT_LT(error[1], error[0] / 12);
}

TEST(RenderMesh, TrianglesFaceTheNormals) {
  const Ribbon ribbon = strip(30);
  const auto [kappa, eta] = random_strains(ribbon, 0.3, 5);
  const Mesh mesh = render_mesh(ribbon, hinged_chain(ribbon, kappa, eta), 2, 3);
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.points[t[0]];
    const Vec3 area = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
    EXPECT_GT(area.dot(mesh.normals[t[0]]), 0);
  }
}

TEST(RenderMesh, FieldsFollowTheNodesLinearly) {
  const Ribbon ribbon = strip(4);
  const auto [kappa, eta] = random_strains(ribbon, 0.3, 8);
  const State state = hinged_chain(ribbon, kappa, eta);
  const Mesh mesh = render_mesh(ribbon, state, 2, 1);
  ASSERT_EQ(mesh.fields.size(), 5u);
  EXPECT_EQ(mesh.fields[2].name, "kappa");
  EXPECT_EQ(mesh.fields[3].name, "tau");
  EXPECT_EQ(mesh.fields[4].name, "eta");
  for (const auto& field : mesh.fields) ASSERT_EQ(field.values.size(), mesh.points.size());
  EXPECT_NEAR(mesh.fields[2].values[2 * 2 * 2], kappa[2], 1e-12);
  EXPECT_NEAR(mesh.fields[3].values[2 * 2 * 2], kappa[2] * eta[2], 1e-12);
  EXPECT_NEAR(mesh.fields[4].values[2 * 3], 0.5 * (eta[1] + eta[2]), 1e-12);
}

/// A Moebius-like loop: the surface must meet itself across the seam, turned over, and not be welded there.
// @eq Shen2015:6.2
TEST(RenderMesh, ClosesAcrossTheSeamOfAMoebiusStrip) {
  RibbonSpec spec;
  spec.segments = 60;
  spec.width = 0.05;
  spec.closure = Closure::loop;
  spec.half_twists = 1;
  const Ribbon ribbon = make_ribbon(spec);
  State state = testing::closed_strip(ribbon, testing::closed_curve(60, 0.3), 0);
  for (std::size_t i = 0; i <= 60; ++i) state.eta[i] = 0.2 * std::cos(std::numbers::pi * static_cast<double>(i) / 60);
  const int across = 4;
  const Mesh mesh = render_mesh(ribbon, state, 2, across);
  const std::size_t last = mesh.points.size() - (across + 1);
  for (std::size_t b = 0; b <= across; ++b) {
    EXPECT_NEAR((mesh.points[b] - mesh.points[last + across - b]).norm(), 0, 1e-14);
    EXPECT_NEAR((mesh.normals[b] + mesh.normals[last + across - b]).norm(), 0, 1e-14);
  }
  const auto samples = centerline(ribbon, state);
  EXPECT_NEAR((samples.front().d1 + samples.back().d1).norm(), 0, 1e-14);
  EXPECT_NEAR((samples.front().d3 - samples.back().d3).norm(), 0, 1e-14);
  EXPECT_NEAR(samples.front().kappa, -samples.back().kappa, 1e-12);
  EXPECT_NEAR(samples.front().tau, samples.back().tau, 1e-12);
  EXPECT_NEAR(samples.front().eta_prime, -samples.back().eta_prime, 1e-12);
  EXPECT_GT(std::abs(samples.front().kappa), 0.1);
}

TEST(Centerline, TakesTheMeanOfTheTwoSegments) {
  const Ribbon ribbon = strip(3, 3.0, 0.1);
  const State state = hinged_chain(ribbon, {0, 0.2, -0.1, 0}, {0, 0.4, -0.2, 0});
  const auto samples = centerline(ribbon, state);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_DOUBLE_EQ(samples[2].u, 2.0);
  EXPECT_NEAR(samples[1].kappa, 0.2, 1e-13);
  EXPECT_NEAR(samples[1].tau, 0.08, 1e-13);
  EXPECT_NEAR(samples[1].eta_prime, 0.5 * (0.4 - 0.6), 1e-13);
  EXPECT_NEAR(samples[3].eta_prime, 0.2, 1e-13);
  EXPECT_EQ(samples[0].kappa, 0);
  const Vec3 mean = (state.q[0] * Vec3::UnitX() + state.q[1] * Vec3::UnitX()).normalized();
  EXPECT_GT(samples[1].d1.dot(mean), 0.9999);
}

/// Folds a paper pattern by hand, ruling by ruling, and compares with the strip: the signs of x, y and the folds.
TEST(FlatPattern, FoldsIntoTheStrip) {
  const Ribbon ribbon = strip(15);
  const auto [kappa, eta] = random_strains(ribbon, 0.6, 11);
  const State state = hinged_chain(ribbon, kappa, eta);
  const FlatPattern pattern = flat_pattern(ribbon, state);
  ASSERT_EQ(pattern.rulings.size(), 16u);
  // A paper in the plane z = 0, seen from +z = d1.
  const auto lift = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0); };
  std::vector<std::array<Vec3, 2>> paper;
  for (const auto& ruling : pattern.rulings) paper.push_back({lift(ruling[0]), lift(ruling[1])});
  for (std::size_t i = 14; i >= 1; --i) {  // from the far end inwards, so that each fold moves the rest rigidly
    const Vec3 origin = paper[i][0];
    const Vec3 axis = (paper[i][1] - paper[i][0]).normalized();  // towards +d2
    const Quat fold = math::exp_map(pattern.fold_angle[i] * axis);
    for (std::size_t k = i + 1; k < paper.size(); ++k) {
      for (Vec3& p : paper[k]) p = origin + fold * (p - origin);
    }
  }
  // Bring the strip's first facet into the plane of the paper.
  const Quat place = straight_state(ribbon).q[0] * state.q[0].conjugate();
  for (std::size_t i = 0; i < paper.size(); ++i) {
    const std::size_t s = std::min<std::size_t>(i, 14);
    const Mat3 frame = state.q[s].toRotationMatrix();
    const Vec3 ruling = frame.col(1) + eta[i] * frame.col(2);
    for (int side = 0; side < 2; ++side) {
      const double v = (side == 0 ? -0.5 : 0.5) * ribbon.width;
      const Vec3 expected = place * (state.r[i] + v * ruling - state.r[0]);
      EXPECT_NEAR((paper[i][side] - expected).norm(), 0, 1e-12) << "node " << i;
    }
  }
}

}  // namespace
}  // namespace wunderlich::geometry
