// The paper's orientation constraint at an end of the strip: it holds the rotation about the centerline only.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/paths.hpp"

namespace wunderlich::testing {
namespace {

/// Length 1, width 0.1, D = 1, clamped along +x at its start; its end brought to (0.8, 0, 0), turned about the
/// centerline, its tangent free.
PathEnd turned(int segments, double turn) {
  geometry::RibbonSpec spec;
  spec.segments = segments;
  spec.clamped = {true, false};
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}),
                           moving_clamp(segments, {Vec3(1, 0, 0), straight_frame()}, Vec3(0.8, 0, 0), turn)};
  surroundings.supports[1].segment = segments - 1;
  surroundings.supports[1].orientation = constraint::Orientation::about_tangent;
  solver::PathOptions options;
  options.barrier = 1e-9;
  return run_path(spec, surroundings, options);
}

TEST(OrientationAtAnEnd, ConvergesToSecondOrder) {
  std::vector<double> changes;
  double before = 0;
  for (const int n : {20, 40, 80, 160}) {
    const PathEnd end = turned(n, 1.0);
    expect_exact(end);
    if (before > 0) changes.push_back(std::abs(end.energy - before));
    before = end.energy;
  }
  expect_second_order(changes);
}

TEST(OrientationAtAnEnd, LeavesTheTangentFree) {
  const PathEnd end = turned(40, 1.0);
  const Vec3 tangent = end.shape.q.back() * Vec3::UnitZ();
  EXPECT_LT(tangent.x(), 0.95);                                                    // a full clamp would keep it along x
  EXPECT_LT(std::abs(geometry::strains(end.ribbon(), end.shape).kappa[39]), 0.2);  // no moment bends the end
}

TEST(OrientationAtAnEnd, ReactionIsTheSlopeOfTheEnergy) {
  const double step = 1e-3;
  const PathEnd end = turned(40, 1.0), less = turned(40, 1.0 - step), more = turned(40, 1.0 + step);
  solver::NewtonWorkspace work;
  const solver::EndReactions reactions = solver::end_reactions(end.path, end.at, work);
  const Vec3 tangent = end.shape.q.back() * Vec3::UnitZ();
  EXPECT_LT(reactions.torque[1].cross(tangent).norm(), 1e-9 * reactions.torque[1].norm());
  EXPECT_NEAR(reactions.torque[1].dot(tangent), (more.energy - less.energy) / (2 * step),
              1e-2 * std::abs(reactions.torque[1].norm()));
}

}  // namespace
}  // namespace wunderlich::testing
