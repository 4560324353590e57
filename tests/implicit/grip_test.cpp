// A hand that pulls a segment: at rest it is a dead force.
#include <gtest/gtest.h>

#include <cmath>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"

namespace wunderlich::testing {
namespace {

// A segment is straight, so that a force on its middle is half of it on either node: the equilibrium solver knows that.
TEST(Grip, AtRestIsADeadForceOnTheSegment) {
  const geometry::RibbonSpec spec = sheet(1e-3, true);
  const double barrier = 1e-3, bending = spec.bending_stiffness * spec.width / std::pow(spec.length, 3);
  constraint::Grip grip;
  grip.segment = spec.segments - 1;
  grip.stiffness = 40 * bending;
  grip.target.position = {0.3, 0.03, 0.25};  // up and out: a strip that is pushed may buckle either way
  constraint::Surroundings surroundings;
  surroundings.supports = {level_clamp(spec, 0)};
  surroundings.grips = {grip};
  Motion motion = make_motion(spec, surroundings, barrier);
  motion.options.drag_tangent = motion.options.drag_normal = 8;
  start(motion);
  for (int i = 1; i <= 240; ++i) ASSERT_TRUE(move_to(0.05 * i, motion)) << motion.failure;
  const geometry::State shape = implicit::shape_of(motion.path, motion.state);
  const auto n = static_cast<std::size_t>(spec.segments);
  for (const Vec3& v : shape.r_dot) ASSERT_LT(v.norm(), 1e-7 * spec.length);  // at rest
  const Vec3 force = grip.stiffness * (grip.target.position - 0.5 * (shape.r[n - 1] + shape.r[n]));
  EXPECT_GT(force.norm(), bending * spec.length);  // the strip is bent far

  constraint::Surroundings pulled;
  pulled.supports = surroundings.supports;
  for (const int node : {spec.segments - 1, spec.segments}) {
    constraint::Load load;
    load.node = node;
    load.keys = {{0, Vec3::Zero(), Vec3::Zero()}, {1, 0.5 * force, Vec3::Zero()}};
    pulled.loads.push_back(load);
  }
  solver::PathOptions options;
  options.barrier = barrier;
  const PathEnd rest = run_path(spec, pulled, options);
  ASSERT_TRUE(rest.done) << rest.failure;
  for (std::size_t i = 0; i <= n; ++i) EXPECT_LT((rest.shape.r[i] - shape.r[i]).norm(), 1e-6 * spec.length) << i;
}

}  // namespace
}  // namespace wunderlich::testing
