#include "wunderlich/geometry/topology.hpp"

#include <gtest/gtest.h>

#include "geometry/chains.hpp"

namespace wunderlich::geometry {
namespace {

using testing::closed_curve;
using testing::closed_strip;

Ribbon loop(int segments, int half_twists) {
  RibbonSpec spec;
  spec.segments = segments;
  spec.closure = Closure::loop;
  spec.half_twists = half_twists;
  return make_ribbon(spec);
}

std::vector<Vec3> circle(int segments) {
  std::vector<Vec3> points;
  const double radius = 0.5 / segments / std::sin(std::numbers::pi / segments);
  for (int i = 0; i <= segments; ++i) {
    const double t = 2 * std::numbers::pi * (i % segments) / segments;
    points.emplace_back(radius * std::cos(t), radius * std::sin(t), 0);
  }
  return points;
}

TEST(Twist, OfAnOpenStripAddsUpMoreThanATurn) {
  RibbonSpec spec;
  spec.segments = 20;
  spec.clamped = {true, true};
  const Ribbon ribbon = make_ribbon(spec);
  State state = straight_state(ribbon);
  const double total = 5.0;  // rad over the whole length, half cells at the ends included
  for (std::size_t s = 0; s < 20; ++s) {
    state.q[s] = state.q[s] * math::exp_map(Vec3(0, 0, total * (static_cast<double>(s) + 0.5) / 20));
  }
  state.end_frame[1] = state.end_frame[1] * math::exp_map(Vec3(0, 0, total));
  EXPECT_NEAR(twist(ribbon, state), total / (2 * std::numbers::pi), 1e-13);
  for (Quat& q : state.q) q = math::exp_map(Vec3(1, 2, 3)) * q;
  const Vec3 axis = math::exp_map(Vec3(1, 2, 3)) * Vec3::UnitX();
  for (std::size_t i = 0; i <= 20; ++i) state.r[i] = ribbon.node_u[i] * axis;
  for (Quat& q : state.end_frame) q = math::exp_map(Vec3(1, 2, 3)) * q;
  EXPECT_NEAR(twist(ribbon, state), total / (2 * std::numbers::pi), 1e-12) << "a rigid motion changes nothing";
  EXPECT_EQ(writhe(ribbon, state), 0);
}

TEST(Twist, OfAPlanarRingIsZero) {
  const Ribbon ribbon = loop(24, 0);
  const State state = closed_strip(ribbon, circle(24), 0);
  EXPECT_NEAR(twist(ribbon, state), 0, 1e-14);
  EXPECT_NEAR(writhe(ribbon, state), 0, 1e-14);
}

TEST(Link, OfATwistedCircleCountsHalfTwists) {
  for (int half_twists : {-3, -2, -1, 1, 2, 5}) {
    const Ribbon ribbon = loop(50, half_twists);
    const int whole = half_twists >= 0 ? half_twists / 2 : -((1 - half_twists) / 2);
    State state = closed_strip(ribbon, circle(50), 0);
    const Topology base = topology(ribbon, state);
    EXPECT_NEAR(std::abs(base.link), half_twists % 2 == 0 ? 0.0 : 0.5, 1e-13);
    const State wound = closed_strip(ribbon, circle(50), whole);
    EXPECT_NEAR(topology(ribbon, wound).link - base.link, whole, 1e-13);
  }
}

TEST(Link, OfASpaceCurveIsAHalfIntegerExactly) {
  for (int half_twists : {0, 1}) {
    for (double height : {0.2, 0.6, 1.5}) {
      const Ribbon ribbon = loop(80, half_twists);
      const Topology found = topology(ribbon, closed_strip(ribbon, closed_curve(80, height), 1));
      EXPECT_GT(std::abs(found.writhe), 0.02) << "a planar curve would say nothing about the writhe";
      const double turns = found.link - 0.5 * half_twists;
      EXPECT_NEAR(turns, std::round(turns), 1e-11) << "height " << height;
    }
  }
}

TEST(Writhe, ChangesSignInAMirrorAndNotWithScale) {
  const Ribbon ribbon = loop(60, 0);
  State state = closed_strip(ribbon, closed_curve(60, 0.8), 0);
  const double found = writhe(ribbon, state);
  for (Vec3& r : state.r) r *= 1e-3;
  EXPECT_NEAR(writhe(ribbon, state), found, 1e-12);
  for (Vec3& r : state.r) r.z() = -r.z();
  EXPECT_NEAR(writhe(ribbon, state), -found, 1e-12);
  EXPECT_GT(std::abs(found), 0.02);
}

TEST(Writhe, AgreesWithTheGaussIntegralByQuadrature) {
  const Ribbon ribbon = loop(30, 0);
  const State state = closed_strip(ribbon, closed_curve(30, 1.0), 0);
  const int fine = 40;  // midpoints a segment
  double sum = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    for (std::size_t j = 0; j < 30; ++j) {
      if (i == j) continue;
      const Vec3 di = (state.r[i + 1] - state.r[i]) / fine, dj = (state.r[j + 1] - state.r[j]) / fine;
      for (int a = 0; a < fine; ++a) {
        for (int b = 0; b < fine; ++b) {
          const Vec3 gap = state.r[i] + (a + 0.5) * di - state.r[j] - (b + 0.5) * dj;
          sum += di.cross(dj).dot(gap) / std::pow(gap.norm(), 3);
        }
      }
    }
  }
  EXPECT_NEAR(writhe(ribbon, state), sum / (4 * std::numbers::pi), 1e-4);
}

TEST(Writhe, OfAPlanarFigureThatCrossesItselfIsZero) {
  const Ribbon ribbon = loop(64, 2);
  std::vector<Vec3> points;
  const Quat tilt = math::exp_map(Vec3(0.5, 0.3, -0.9));
  for (int i = 0; i <= 64; ++i) {
    const double t = 2 * std::numbers::pi * (i % 64 + 0.37) / 64;
    points.push_back(tilt * Vec3(std::sin(t), std::sin(2 * t), 0));
  }
  EXPECT_NEAR(topology(ribbon, closed_strip(ribbon, points, 0)).writhe, 0, 1e-12);
}

TEST(KappaZeros, InterpolatesBetweenNodes) {
  RibbonSpec spec;
  spec.segments = 4;
  const Ribbon ribbon = make_ribbon(spec);
  const auto zeros = kappa_zeros(ribbon, {0, 1, -3, -1, 0});
  ASSERT_EQ(zeros.size(), 1u);
  EXPECT_NEAR(zeros[0], 0.25 + 0.25 * 0.25, 1e-15);
}

TEST(KappaZeros, CountsAnExactZeroOnceAndTouchingNever) {
  RibbonSpec spec;
  spec.segments = 4;
  const Ribbon ribbon = make_ribbon(spec);
  const auto crossing = kappa_zeros(ribbon, {0, 2, 0, -2, 0});
  ASSERT_EQ(crossing.size(), 1u);
  EXPECT_NEAR(crossing[0], 0.5, 1e-15);
  EXPECT_TRUE(kappa_zeros(ribbon, {0, 2, 0, 2, 0}).empty());
  EXPECT_TRUE(kappa_zeros(ribbon, {0, 1e-14, -1e-14, 1e-14, 0}).empty()) << "rounding noise of a flat strip";
}

TEST(KappaZeros, FollowsALoopAcrossTheSeam) {
  const Ribbon moebius = loop(4, 1);
  // kappa(l) = -kappa(0) is no zero on a Moebius strip; the sign change between nodes 1 and 2 is one.
  const auto inside = kappa_zeros(moebius, {1, 1, -1, -1, -1});
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_NEAR(inside[0], 0.375, 1e-15);
  const auto at_seam = kappa_zeros(moebius, {0, 1, 1, 1, 0});
  ASSERT_EQ(at_seam.size(), 1u);
  EXPECT_NEAR(at_seam[0], 0, 1e-15);
  const Ribbon ring = loop(4, 0);
  EXPECT_EQ(kappa_zeros(ring, {1, 1, -1, -1, 1}).size(), 2u);
  EXPECT_TRUE(kappa_zeros(ring, {0, 1, 1, 1, 0}).empty());
}

}  // namespace
}  // namespace wunderlich::geometry
