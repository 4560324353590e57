// Rods in motion: what implicit Euler must do exactly, a frequency, and a solid that keeps them out.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/rods.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kStep = 0.01;

Rod strip_rod(int segments) {
  geometry::RibbonSpec spec;
  spec.segments = segments;
  return rod::make_rod(spec, rod::physical(spec, 0.3, 0.01));
}

// @eq Bergou2010
TEST(RodMotion, FallsSlowsDownAndSpinsAsImplicitEulerSays) {
  const Rod sample = strip_rod(10);
  rod::State state = rod::straight_state(sample);
  for (Vec3& v : state.v) v = Vec3(0, 2, 0);
  for (double& rate : state.theta_dot) rate = 3;
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -10);
  const rod::Damping damping{1, 4};
  rod::Workspace work;
  Vec3 v(0, 2, 0), moved = Vec3::Zero();
  double rate = 3, turned = 0;
  for (int k = 1; k <= 20; ++k) {
    ASSERT_TRUE(rod::step(sample, surroundings, damping, k * kStep, {}, state, work).converged());
    v = (v + kStep * surroundings.gravity) / (1 + 4 * kStep);  // the strip lies along x: all motion is across it
    moved += kStep * v;
    rate /= 1 + 4 * kStep;
    turned += kStep * rate;
  }
  for (std::size_t i = 0; i < sample.nodes(); ++i) {
    EXPECT_LE((state.v[i] - v).norm(), 1e-9);
    EXPECT_LE((state.x[i] - rod::straight_state(sample).x[i] - moved).norm(), 1e-9);
  }
  for (std::size_t j = 0; j < sample.edges(); ++j) EXPECT_NEAR(state.theta[j], turned, 1e-9);
}

TEST(RodMotion, FreeRodKeepsItsMomentum) {
  const Rod sample = strip_rod(12);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  rod::State state = rod::straight_state(sample);
  for (Vec3& v : state.v) v = Vec3(normal(random), normal(random), normal(random));
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < sample.nodes(); ++i) sum += sample.node_mass[i] * state.v[i];
    return sum;
  };
  const Vec3 before = momentum();
  rod::Workspace work;
  double energy = rod::kinetic_energy(sample, state);
  for (int k = 1; k <= 30; ++k) {
    ASSERT_TRUE(rod::step(sample, {}, {}, k * 0.002, {}, state, work).converged());
    const double now = rod::kinetic_energy(sample, state) + rod::elastic_energy(sample, state).sum();
    EXPECT_LE(now, energy * (1 + 1e-9));  // implicit Euler loses energy, never gains it
    energy = now;
  }
  EXPECT_LE((momentum() - before).norm(), 1e-7 * before.norm());
}

TEST(RodMotion, CantileverSwingsAtItsFrequency) {
  // The first edge is clamped: it bends from its middle on.
  const Rod sample = strip_rod(30);
  const double length = 1 - 0.5 / 30;
  const double expected = 1.8751 * 1.8751 / (length * length) * std::sqrt(sample.stiffness.soft / 0.1);  // Timoshenko
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0)};
  rod::State state = rod::straight_state(sample);
  for (std::size_t i = 0; i < sample.nodes(); ++i) state.v[i].z() = 1e-3 * state.x[i].x() * state.x[i].x();
  rod::Workspace work;
  const double h = 2 * kPi / expected / 1000;
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int k = 1; k <= 3200; ++k) {
    ASSERT_TRUE(rod::step(sample, surroundings, {}, k * h, {}, state, work).converged());
    const double now = state.x.back().z();
    if (before > 0 && now <= 0) {
      last = (k - now / (now - before)) * h;
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  ASSERT_EQ(crossings, 3);
  EXPECT_NEAR(2 * kPi * 2 / (last - first), expected, 0.01 * expected);
}

TEST(RodMotion, DrapesOverACylinderWithoutEnteringIt) {
  geometry::RibbonSpec spec;
  spec.length = 0.3;
  spec.width = 0.03;
  spec.segments = 20;
  spec.bending_stiffness = 2e-5;
  spec.area_density = 0.1;
  const Rod sample = rod::make_rod(spec, rod::physical(spec, 0.3, 3e-4));
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -9.81);
  const Quat axis = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(0.3, 1, 0).normalized());
  surroundings.obstacles = {{contact::Cylinder{0.03, 0.1}, {{{0, {Vec3(0.14, 0, -0.06), axis}, 0}}}, 0}};
  surroundings.contact.distance = 0.001;
  rod::State state = rod::straight_state(sample);
  rod::Workspace work;
  double nearest = 1;
  for (int k = 1; k <= 150; ++k) {
    const rod::Report report = rod::step(sample, surroundings, {1, 1}, k * 0.002, {}, state, work);
    ASSERT_TRUE(report.converged()) << k << " " << rod::outcome_name(report.outcome);
    nearest = std::min(nearest, rod::clearance(sample, surroundings, state));
  }
  EXPECT_GT(nearest, 0);
  EXPECT_LT(nearest, 0.001);                                    // it did touch,
  EXPECT_GT(state.x[10].z(), -0.04);                            // lies on top
  EXPECT_LT(std::max(state.x[0].z(), state.x[20].z()), -0.06);  // and both ends hang down.
}

}  // namespace
}  // namespace wunderlich::testing
