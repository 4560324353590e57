// The paper's orientation constraint at an end of the strip: it holds the rotation about the centerline only.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/paths.hpp"

namespace wunderlich::testing {
namespace {

using constraint::Orientation;

/// Length 1, width 0.3, D w = 0.1, one end clamped along +x, the other brought to 0.8 of the length from it and turned
/// about the centerline, its tangent free. `free_end`: which of the two (0, 1).
PathEnd turned(int segments, double turn, int free_end) {
  geometry::RibbonSpec spec;
  spec.segments = segments;
  spec.width = 0.3;
  spec.bending_stiffness = 1.0 / 3;
  spec.clamped = {true, true};
  const Pose start{Vec3::Zero(), straight_frame()}, end{Vec3(1, 0, 0), straight_frame()};
  constraint::Surroundings surroundings;
  if (free_end == 1) {
    surroundings.supports = {clamp(0, start), moving_clamp(segments, end, Vec3(0.8, 0, 0), turn)};
  } else {
    surroundings.supports = {clamp(segments, end), moving_clamp(0, start, Vec3(0.2, 0, 0), turn)};
  }
  surroundings.supports[1].orientation = Orientation::about_tangent;
  solver::PathOptions options;
  options.barrier = 1e-9;
  options.steps = 10;  // what transport does to the frame depends on the steps
  return run_path(spec, surroundings, options);
}

class OrientationAtAnEnd : public ::testing::TestWithParam<int> {};

TEST_P(OrientationAtAnEnd, ConvergesToSecondOrder) {
  std::vector<double> changes;
  double before = 0;
  for (const int n : {20, 40, 80, 160}) {
    const PathEnd end = turned(n, 0.5, GetParam());
    expect_exact(end);
    if (before > 0) changes.push_back(std::abs(end.energy - before));
    before = end.energy;
  }
  expect_second_order(changes);
}

TEST_P(OrientationAtAnEnd, LeavesTheTangentFree) {
  const PathEnd end = turned(40, 0.5, GetParam());
  const Vec3 tangent = end.shape.end_frame[static_cast<std::size_t>(GetParam())] * Vec3::UnitZ();
  EXPECT_LT(tangent.x(), 0.95);  // a full clamp would keep it along x
}

TEST_P(OrientationAtAnEnd, ReactionsBalance) {
  const PathEnd end = turned(40, 0.5, GetParam());
  solver::NewtonWorkspace work;
  const solver::EndReactions reactions = solver::end_reactions(end.path, end.at, work);
  const auto at = static_cast<std::size_t>(GetParam());
  const Vec3 tangent = end.shape.end_frame[at] * Vec3::UnitZ();
  EXPECT_GT(reactions.torque[at].norm(), 0.01);
  EXPECT_LT(reactions.torque[at].cross(tangent).norm(), 1e-6 * reactions.torque[at].norm());
  EXPECT_LT((reactions.force[0] + reactions.force[1]).norm(), 1e-8 * reactions.force[0].norm());
  const Vec3 arm = end.shape.r.back() - end.shape.r.front();
  EXPECT_LT((reactions.torque[0] + reactions.torque[1] + arm.cross(reactions.force[1])).norm(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Ends, OrientationAtAnEnd, ::testing::Values(0, 1));

}  // namespace
}  // namespace wunderlich::testing
