// Motions that drag brings to rest, against the equilibrium solver: from where the motion ended, and from the start.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"

namespace wunderlich::testing {
namespace {

/// A strip under tension, twisted by half a turn, as in scenes/twist-pi.yaml.
PathEnd twist_pi(double barrier) {
  geometry::RibbonSpec spec;
  spec.length = 1;
  spec.width = 0.4 / kPi;
  spec.segments = 35;
  spec.clamped = {true, true};
  constraint::Surroundings surroundings;
  const Quat frame = straight_frame();
  constraint::Support end = moving_clamp(35, {Vec3(1, 0, 0), frame}, Vec3(1, 0, 0), kPi);
  end.hold_position = {false, true, true};
  surroundings.supports = {clamp(0, {Vec3::Zero(), frame}), end};
  constraint::Load pull;
  pull.node = 35;
  pull.keys = {{0, Vec3(5, 0, 0), Vec3::Zero()}, {1, Vec3(250 * kPi, 0, 0), Vec3::Zero()}};
  surroundings.loads = {pull};
  solver::PathOptions options;
  options.barrier = barrier;
  return run_path(spec, surroundings, options);
}

struct Rest {
  double most = 0;      ///< elastic energy over the one at rest, at most
  double dynamic = 0;   ///< elastic energy where the motion ended, relative to the equilibrium's, less 1
  double polished = 0;  ///< the same after the equilibrium solver's last steps from there
};

/// Pushes an equilibrium and lets drag bring it back to rest.
Rest push_and_rest(const PathEnd& at, double speed, double drag, double dt, int steps) {
  Motion m;
  m.path = at.path;
  m.options.barrier = at.path.options.barrier;
  m.options.drag_tangent = m.options.drag_normal = drag;
  geometry::State shape = at.shape;
  shape.time = at.path.options.duration;
  const bool loop = m.path.ribbon.is_loop();
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    const double u = 2 * kPi * m.path.ribbon.node_u[i] / m.path.ribbon.length;
    const double share = loop ? 1 : 0.5 * (1 - std::cos(u));  // nothing at held ends
    shape.r_dot[i] = speed * share * Vec3(std::cos(2 * u), std::sin(u), std::sin(3 * u));
  }
  start(shape, Vec3::Zero(), m);
  Rest rest;
  const auto elastic = [&] {
    return solver::elastic_energy(m.path.ribbon, m.path.options.model, m.state.strips[0].path.chain) / at.energy - 1;
  };
  for (int i = 1; i <= steps; ++i) {
    EXPECT_TRUE(move_to(shape.time + dt * i, m)) << m.failure;
    rest.most = std::max(rest.most, elastic());
  }
  rest.dynamic = elastic();
  std::printf("  %d steps, %d iterations, %d halvings, %d repeats; kinetic over elastic %.3g\n", m.steps, m.iterations,
              m.halvings, m.repeats, kinetic(m) / at.energy);
  solver::PathState polish = m.state.strips[0].path;
  polish.phase = solver::Phase::settle;
  polish.t = 0;
  solver::NewtonWorkspace work;
  const solver::PathStep step = solver::advance(m.path, polish, work);
  EXPECT_TRUE(step.accepted) << step.failure;
  EXPECT_EQ(polish.phase, solver::Phase::done);
  rest.polished = solver::elastic_energy(m.path.ribbon, m.path.options.model, polish.chain) / at.energy - 1;
  return rest;
}

void expect_same(const Rest& rest) {
  std::printf("  most elastic energy on the way - 1: %.3g\n", rest.most);
  show("energy at rest - 1", rest.dynamic, 1e-6);
  show("energy polished - 1", rest.polished, 1e-6);
  EXPECT_GT(rest.most, 0.01);  // it has been away
  EXPECT_LE(std::abs(rest.dynamic), 1e-6);
  EXPECT_LE(std::abs(rest.polished), 1e-6);
}

TEST(Rest, OfAMoebiusStripIsItsEquilibrium) {
  const PathEnd at = moebius(50, 0.4, 1e-9);
  ASSERT_TRUE(at.done);
  expect_same(push_and_rest(at, 0.8, 1.5, 0.02, 1000));
}

TEST(Rest, OfAStripTwistedUnderTensionIsItsEquilibrium) {
  const PathEnd at = twist_pi(1e-9);
  ASSERT_TRUE(at.done) << at.failure;
  expect_same(push_and_rest(at, 2, 20, 1e-3, 1500));
}

}  // namespace
}  // namespace wunderlich::testing
