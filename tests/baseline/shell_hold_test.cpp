// What holds and loads a shell.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/shells.hpp"

namespace wunderlich::baseline::shell {

namespace {

class ShellHold : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Both, ShellHold, ::testing::Values(Kind::conforming, Kind::nonconforming));

geometry::RibbonSpec strip_of(std::array<bool, 2> clamped) {
  geometry::RibbonSpec strip;
  strip.width = 0.3;
  strip.segments = 10;
  strip.clamped = clamped;
  return strip;
}

// A clamp that may slide along x gives all its points one unknown there and none elsewhere.
TEST_P(ShellHold, ASlidingClampMovesAsOne) {
  const geometry::RibbonSpec strip = strip_of({true, true});
  const Shell shell = make(GetParam(), strip, 6, 3);
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp_at(strip, false), clamp_at(strip, true)};
  surroundings.supports[1].hold_position = {false, true, true};
  const Hold hold = make_hold(shell, surroundings, 0);
  EXPECT_EQ(hold.unknown_count[0], hold.unknown_count[1] + 1);
  EXPECT_EQ(hold.unknown_count[1], hold.unknown_count[2]);

  surroundings.supports[1].motion.keys.push_back({1, surroundings.supports[1].motion.keys[0].pose, 0.5});
  constraint::Load pull;
  pull.node = strip.segments;
  pull.keys = {{0, Vec3(40, 0, 0), Vec3::Zero()}};
  surroundings.loads = {pull};
  State state = straight_state(shell, surroundings);
  Work work;
  const Points before = state.x;
  for (int k = 1; k <= 10; ++k) ASSERT_TRUE(step(shell, surroundings, {}, 0.002 * k, state, work).accepted) << k;
  const Mat3 turn = Eigen::AngleAxisd(0.5 * 0.02, Vec3::UnitX()).toRotationMatrix();
  int held = 0;
  for (int p = 0; p < shell.point_count(); ++p) {
    const bool start = shell.flat[static_cast<std::size_t>(p)].x() < 1e-9;
    const bool end = shell.flat[static_cast<std::size_t>(p)].x() > 1 - 1e-9;
    EXPECT_LT(start ? (state.x.row(p) - before.row(p)).norm() : 0, 1e-15);
    if (!end) continue;
    const double slide = state.x(shell.point_count() - 1, 0) - before(shell.point_count() - 1, 0);
    const Vec3 expected = turn * Vec3(before.row(p)) + slide * Vec3::UnitX();
    EXPECT_LT((Vec3(state.x.row(p)) - expected).norm(), 1e-14);
    EXPECT_GT(std::abs(slide), 1e-12);
    ++held;
  }
  EXPECT_GT(held, 5);
}

TEST_P(ShellHold, LoadsHaveTheirForceAndTorque) {
  geometry::RibbonSpec strip = strip_of({false, false});
  const Shell shell = make(GetParam(), strip, 6, 3);
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 1, -3);
  constraint::Load load;
  load.node = strip.segments;
  load.keys = {{0, Vec3(1, 2, 3), Vec3(0.4, 0, -0.7)}};
  surroundings.loads = {load};
  const Points x = straight_points(shell);
  Points force = Points::Zero(shell.point_count(), 3);
  add_loads(shell, surroundings, x, 0, force);
  const double mass = strip.area_density * strip.length * strip.width;
  EXPECT_LT((Vec3(force.colwise().sum()) - mass * surroundings.gravity - Vec3(1, 2, 3)).norm(), 1e-12);
  Vec3 torque = Vec3::Zero();
  for (int p = 0; p < shell.point_count(); ++p) torque += (Vec3(x.row(p)) - Vec3(1, 0, 0)).cross(Vec3(force.row(p)));
  const Vec3 of_gravity = (Vec3(0.5, 0, 0) - Vec3(1, 0, 0)).cross(mass * surroundings.gravity);
  EXPECT_LT((torque - of_gravity - Vec3(0.4, 0, -0.7)).norm(), 1e-12);
}

TEST_P(ShellHold, AReleasedClampLetsGo) {
  const geometry::RibbonSpec strip = strip_of({true, false});
  const Shell shell = make(GetParam(), strip, 6, 3);
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -10);
  surroundings.supports = {clamp_at(strip, false)};
  surroundings.supports[0].release = 0.05;
  State state = straight_state(shell, surroundings);
  const double height = state.x(0, 2);
  Work work;
  for (int k = 1; k <= 10; ++k) {
    ASSERT_TRUE(step(shell, surroundings, {}, 0.01 * k, state, work).accepted) << k;
    EXPECT_EQ(k <= 5, std::abs(state.x(0, 2) - height) < 1e-12) << k;
  }
  EXPECT_LT(state.x(0, 2), height - 1e-3);
}

// Two points beside the centerline keep their distance: their mean is held, and they turn about it.
TEST_P(ShellHold, APinBetweenTwoRowsHoldsTheirMean) {
  const geometry::RibbonSpec strip = strip_of({false, false});
  const Shell shell = make(GetParam(), strip, 6, 4);
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -1);
  for (const bool end : {false, true}) {
    surroundings.supports.push_back(clamp_at(strip, end));
    surroundings.supports.back().orientation = constraint::Orientation::free;
  }
  for (const Metric metric : {Metric::mass, Metric::implicit}) {
    Options options;
    options.metric = metric;
    State state = straight_state(shell, surroundings);
    Work work;
    for (int k = 1; k <= 20; ++k) {
      const StepReport report = step(shell, surroundings, options, 1e-3 * k, state, work);
      ASSERT_TRUE(report.accepted) << k << ": " << report.failure;
    }
    Vec3 mean = Vec3::Zero();
    std::vector<Vec3> near;
    for (int p = 0; p < shell.point_count(); ++p) {
      const Vec2& flat = shell.flat[static_cast<std::size_t>(p)];
      if (std::abs(flat.x()) < 1e-9 && std::abs(flat.y()) < 0.051) near.push_back(state.x.row(p).transpose());
    }
    for (const Vec3& point : near) mean += point / static_cast<double>(near.size());
    EXPECT_LT(mean.norm(), 1e-12);
    const bool two = GetParam() == Kind::conforming;
    ASSERT_EQ(near.size(), two ? 2 : 1);
    EXPECT_NEAR((near.back() - near.front()).norm(), two ? 0.1 : 0, 0.01 * 0.1);
    EXPECT_LT(state.x.col(2).minCoeff(), -1e-5);
  }
}

TEST(ShellLimits, SaysWhereSupportsMeetAndHowFarTheyWereShifted) {
  const geometry::RibbonSpec strip = strip_of({false, false});
  const Shell shell = make(Kind::conforming, strip, 6, 3);  // columns at every second node
  constraint::Surroundings surroundings;
  for (const int node : {0, 4}) {
    surroundings.supports.push_back(clamp_at(strip, false));
    surroundings.supports.back().orientation = constraint::Orientation::free;
    surroundings.supports.back().node = node;
  }
  EXPECT_EQ(overlapping(shell, surroundings), "");
  EXPECT_NEAR(largest_shift(shell, surroundings), 0, 1e-15);
  surroundings.supports.push_back(surroundings.supports[1]);
  EXPECT_NE(overlapping(shell, surroundings), "");
  surroundings.supports[1].hold_position = {true, false, false};
  surroundings.supports[2].hold_position = {false, true, true};
  EXPECT_EQ(overlapping(shell, surroundings), "");  // of one mind

  // Between two columns a pin stands in the middle of two points, and a load on both.
  surroundings.supports.resize(1);
  surroundings.supports[0].node = 5;
  constraint::Load load;
  load.node = 5;
  load.keys = {{0, Vec3(1, 2, 3), Vec3::Zero()}};
  surroundings.loads = {load};
  EXPECT_NEAR(largest_shift(shell, surroundings), 0, 1e-15);
  const Shell coarse = make(Kind::conforming, strip, 4, 3);  // a third of the length apart
  surroundings.loads[0].node = 6;
  EXPECT_NEAR(largest_shift(coarse, surroundings), 2.0 / 3 - 0.6, 1e-12);
}

TEST(ShellLimits, SaysWhatItDoesNotDo) {
  geometry::RibbonSpec strip = strip_of({true, true});
  constraint::Surroundings surroundings;
  EXPECT_EQ(unsupported(strip, surroundings), "");
  surroundings.contact.self = true;
  EXPECT_EQ(unsupported(strip, surroundings), "the shells do not feel themselves");
  strip.closure = geometry::Closure::loop;
  EXPECT_EQ(unsupported(strip, surroundings), "the shells are open strips");
}

}  // namespace

}  // namespace wunderlich::baseline::shell
