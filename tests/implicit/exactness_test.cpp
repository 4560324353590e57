// Constraints at every step: of a tilted swing, a loop in motion, a strip whose clamp moves and lets go.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"
#include "wunderlich/geometry/topology.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

/// How far the strip's last frame is from where a clamp asks for it, at the end time [lengths, rad].
double end_error(const Motion& m, const constraint::Support& support) {
  const geometry::State shape = implicit::shape_of(m.path, m.state);
  const auto pose = constraint::pose_at(support.motion, m.state.strips[0].path.t);
  return std::max((shape.r.back() - pose.position).norm() / m.path.ribbon.length,
                  math::log_map(shape.end_frame[1] * pose.frame.conjugate()).norm());
}

TEST(Exactness, OfATiltedSwing) {
  Motion m = swing(1e-2, 0.3);
  Exactness worst;
  double lowest = 0, aside = 0;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(move_to(5e-3 * i, m)) << m.failure;
    look(m, worst);
    lowest = std::min(lowest, m.state.strips[0].points.x[50].z());
    aside = std::max(aside, m.state.strips[0].points.x[50].y());
  }
  expect_exact(worst);
  EXPECT_LT(lowest, -0.02);
  EXPECT_GT(aside, 1e-3);  // it leaves the plane
}

TEST(Exactness, OfAMoebiusLoopInMotion) {
  const PathEnd rest = moebius(50, 0.4, 1e-3);
  ASSERT_TRUE(rest.done);
  Motion m;
  m.path = rest.path;
  geometry::State shape = rest.shape;
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    const double u = 2 * kPi * static_cast<double>(i) / 50;
    shape.r_dot[i] = 0.8 * Vec3(std::cos(2 * u), std::sin(u), std::sin(3 * u));
  }
  shape.time = 0;
  start(shape, Vec3::Zero(), m);
  Exactness worst;
  double open = 0, most = 0;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(move_to(0.02 * i, m)) << m.failure;
    look(m, worst);
    const geometry::State now = implicit::shape_of(m.path, m.state);
    const Quat ghost = geometry::across_seam(m.path.ribbon, now.q.front());
    open = std::max({open, (now.r.back() - now.r.front()).norm() / m.path.ribbon.length,
                     math::log_map(now.end_frame[1] * ghost.conjugate()).norm()});
    most = std::max(most, (now.r[13] - rest.shape.r[13]).norm());
    EXPECT_NEAR(geometry::topology(m.path.ribbon, now).link, 0.5, 1e-6);
  }
  expect_exact(worst);
  show("closure, lengths and rad", open, 1e-10);
  EXPECT_LE(open, 1e-10);
  EXPECT_GT(most, 0.3);  // it moves
}

TEST(Exactness, OfAStripWhoseClampTurnsAndLetsGo) {
  Motion m = between_clamps();
  const constraint::Surroundings held = m.path.surroundings;
  const constraint::Support end = held.supports.back();
  Exactness worst;
  double apart = 0;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(move_to(2e-3 * i, m)) << m.failure;
    look(m, worst);
    apart = std::max(apart, end_error(m, end));
  }
  show("prescribed end, lengths and rad", apart, 1e-10);
  EXPECT_LE(apart, 1e-10);

  const geometry::RibbonSpec spec = sheet(2.7e-4, true);
  constraint::Surroundings released = held;
  released.supports.pop_back();
  const solver::PathProblem before = m.path;
  m.path = solver::make_path(geometry::make_ribbon(spec), released, before.options);
  const double energy = total_energy(m);
  implicit::change_supports(before, m.path, m.state.strips.front());
  implicit::find_accelerations(implicit::Paths(&m.path, 1), m.options, m.state, m.work);
  const double lost = energy - total_energy(m);  // that of the clamp's own hinge
  EXPECT_GE(lost, -1e-12 * std::abs(energy));
  EXPECT_LE(lost, 0.2 * m.state.elastic);
  for (int i = 201; i <= 400; ++i) {
    ASSERT_TRUE(move_to(2e-3 * i, m)) << m.failure;
    look(m, worst);
  }
  expect_exact(worst);
  EXPECT_GT(end_error(m, end), 0.1);  // it is gone
  std::printf("  %d steps, %d iterations, %d halvings, %d repeats\n", m.steps, m.iterations, m.halvings, m.repeats);
}

}  // namespace
}  // namespace wunderlich::testing
