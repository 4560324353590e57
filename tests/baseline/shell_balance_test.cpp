// How far a shell is from balance, where that is known.
#include <gtest/gtest.h>

#include <algorithm>

#include "baseline/shells.hpp"
#include "wunderlich/baseline/shell/balance.hpp"

namespace wunderlich::baseline::shell {
namespace {

geometry::RibbonSpec strip(bool clamped) {
  geometry::RibbonSpec spec;
  spec.width = 0.2;
  spec.area_density = 2;
  spec.segments = 10;
  spec.clamped = {clamped, false};
  return spec;
}

double net(const Shell& shell, const constraint::Surroundings& surroundings) {
  State state;
  state.x = straight_points(shell);
  return net_force(shell, surroundings, state).value();
}

double heaviest(const Shell& shell) { return *std::max_element(shell.mass.begin(), shell.mass.end()); }

TEST(ShellBalance, WhatFallsFreelyLacksItsWeight) {
  for (const Kind kind : {Kind::conforming, Kind::nonconforming}) {
    const Shell shell = make(kind, strip(false), 7, 4);
    constraint::Surroundings surroundings;
    surroundings.gravity = Vec3(1, -2, 3);
    EXPECT_NEAR(net(shell, surroundings), heaviest(shell) * surroundings.gravity.norm(), 1e-5);
  }
}

// Along the strip the lengths carry the weight; across it nothing does before it bends, but for the rims of a
// nonconforming shell, whose triangles meet.
TEST(ShellBalance, LengthsCarryWhatTheyCan) {
  const geometry::RibbonSpec spec = strip(true);
  for (const Kind kind : {Kind::conforming, Kind::nonconforming}) {
    const Shell shell = make(kind, spec, 7, 4);
    constraint::Surroundings surroundings;
    surroundings.supports = {clamp_at(spec, false)};
    surroundings.gravity = Vec3(5, 0, 0);
    EXPECT_LE(net(shell, surroundings), 1e-3 * heaviest(shell) * 5);
    surroundings.gravity = Vec3(0, 0, 5);
    if (kind == Kind::conforming) {
      EXPECT_NEAR(net(shell, surroundings), heaviest(shell) * 5, 1e-5);
    } else {
      EXPECT_GE(net(shell, surroundings), heaviest(shell) * 5);
    }
  }
}

}  // namespace
}  // namespace wunderlich::baseline::shell
