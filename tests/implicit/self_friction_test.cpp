// Strips on strips with friction.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "implicit/drops.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kGap = 1e-3;
constexpr double kRest = 6e-8;  // how far the barrier of so stiff a board is pressed in by the weight

/// A stiff board, held at its start, and a shorter, narrower strip on it, under gravity that leans by `slope`, down
/// (1, 1, 0): how fast the strip goes that way on the board after a while.
double slide(double slope, double friction, double duration) {
  geometry::RibbonSpec board = sheet(100, true), strip = sheet(1e-2, false);
  board.width = 0.06, board.segments = 10;
  strip.length = 0.2, strip.segments = 8;
  const double alpha = std::atan(slope);
  const Vec3 down = Vec3(1, 1, 0).normalized();
  constraint::Surroundings surroundings;
  surroundings.gravity = kGravity * (std::sin(alpha) * down - std::cos(alpha) * Vec3::UnitZ());
  surroundings.contact = {kGap, 0, true, friction};
  constraint::Surroundings holds = surroundings;
  holds.supports = {level_clamp(board, 0)};
  solver::PathOptions path_options;
  path_options.barrier = 1e-3;
  const std::array paths{make_path(geometry::make_ribbon(board), holds, path_options),
                         make_path(geometry::make_ribbon(strip), surroundings, path_options)};
  const std::array shapes{
      geometry::straight_state(paths[0].ribbon),
      geometry::state_of(paths[1].ribbon, geometry::straight_chain(paths[1].ribbon, along_x(0.03, kGap - kRest)), 0)};
  const std::array spins{Vec3(Vec3::Zero()), Vec3(Vec3::Zero())};
  implicit::Options options;
  options.integrator = implicit::Integrator::euler;
  implicit::Workspace work;
  implicit::State state = implicit::start(paths, options, shapes, spins, work);
  int touching = 0, steps = 0;
  constexpr double kStep = 2.5e-3;
  for (int i = 1; i * kStep <= duration + 0.5 * kStep; ++i) {
    const implicit::StepReport report = implicit::step(paths, options, i * kStep, 0, state, work);
    EXPECT_TRUE(report.accepted) << report.failure;
    if (!report.accepted) return 0;
    EXPECT_GT(report.nearest, 0);
    touching += report.touching > 0 ? 1 : 0;
    ++steps;
  }
  EXPECT_GT(touching, 0.9 * steps);
  Vec3 speed = Vec3::Zero();
  const geometry::State shape = implicit::shape_of(paths[1], state.strips[1]);
  for (const Vec3& v : shape.r_dot) speed += v / static_cast<double>(shape.r_dot.size());
  EXPECT_LT(std::abs(speed.dot(Vec3(1, -1, 0).normalized())), 0.02 * std::max(1e-3, speed.norm()));
  return speed.dot(down);
}

/// It slips if and only if tan(alpha) > mu. What creeps below that does so at 1 mm/s (1 - sqrt(1 - tan(alpha)/mu)),
/// where the smoothed force is the weight's share along the slope.   @eq Li2020:14
TEST(SelfFriction, AStripSlipsOnAnotherAsCoulombSays) {
  for (const double friction : {0.1, 0.3, 0.6}) {
    if (is_slow_build() && friction != 0.3) continue;
    const double held = slide(0.99 * friction, friction, 0.1), slips = slide(1.01 * friction, friction, 0.3);
    const double steeper = slide(1.5 * friction, friction, 0.1), alpha = std::atan(1.5 * friction);
    show("creep below the threshold [m/s]", held, 0.9e-3);
    show("slip above it [m/s]", slips, 1e-3);
    EXPECT_NEAR(held, 0.9e-3, 0.01e-3);
    EXPECT_GT(slips, 1.1e-3);
    const double free = 0.1 * kGravity * (std::sin(alpha) - friction * std::cos(alpha));
    show("slip well above it, over Coulomb's", steeper / free, 1);
    EXPECT_NEAR(steeper, free, 0.05 * free);  // the first step has no friction
  }
}

}  // namespace
}  // namespace wunderlich::testing
