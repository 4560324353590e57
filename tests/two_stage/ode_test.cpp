// Stage ode: lengths, momentum, order in time, damping, and what happens beyond the stability bound.
#include <gtest/gtest.h>

#include <cmath>

#include "two_stage/cases.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/energy/parallel_coupling.hpp"

namespace wunderlich::testing {
namespace {

Vec3 momentum(const Case& c) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < c.state.shape.r.size(); ++i) sum += c.ribbon.node_mass[i] * c.state.shape.r_dot[i];
  return sum;
}

double bound(const Case& c) {
  return two_stage::stable_step(c.ribbon, two_stage::rest_parallel_weight(c.ribbon, c.options.ode.weight_scale));
}

/// @eq Shen2015:20
TEST(StageOde, KeepsLengthsWhileTheStripFalls) {
  Case c = cantilever(30, 0.3);
  for (int k = 0; k < 40; ++k) EXPECT_LE(run(5e-4, 1, c).constraints.max_length_error, 1e-9);
  EXPECT_LT(c.state.shape.r.back().z(), -1e-3);
}

TEST(StageOde, ConservesLinearMomentumInFreeFlight) {
  Case c = floating(20);
  disturb(0.3, c);
  const Vec3 before = momentum(c);
  run(1e-3, 50, c);
  EXPECT_LE((momentum(c) - before).norm(), 1e-12 * before.norm() + 1e-14);
  EXPECT_GT((c.state.shape.r[0] - c.state.shape.r.back()).norm(), 0.1);
}

TEST(StageOde, FallsFreelyUnderGravity) {
  Case c = floating(12);
  c.drive.gravity = Vec3(0, 0, -9.81);
  const double dt = 1e-3;
  c.options.substeps = false;
  c.ribbon.bending_stiffness = 2.7e-6;
  run(dt, 30, c);
  // Symplectic Euler: z = -g dt^2 k (k + 1)/2.
  for (const Vec3& r : c.state.shape.r) EXPECT_NEAR(r.z(), -9.81 * dt * dt * 30 * 31 / 2, 1e-9);
}

TEST(StageOde, ForceActsOnItsNode) {
  Case c = floating(12);
  c.drive.loads = {{5, Vec3(0, 0, 2e-3), Vec3::Zero()}};
  run(1e-3, 20, c);
  EXPECT_NEAR(momentum(c).z(), 2e-3 * 20e-3, 1e-12);
}

/// Where the tip is after `duration`, in steps of the share `fraction` of the bound.
Vec3 tip_after(double duration, double fraction, double tilt) {
  Case c = cantilever(8, tilt);
  c.options.substeps = false;
  c.options.opt.step_tolerance = 1e-9;
  const int steps = static_cast<int>(std::ceil(duration / (fraction * bound(c))));
  run(duration / steps, steps, c);
  return c.state.shape.r.back();
}

TEST(StageOde, IsOfFirstOrderInTheStep) {
  const double duration = 0.05;
  const Vec3 fine = tip_after(duration, 1.0 / 64, 0), finer = tip_after(duration, 1.0 / 128, 0);
  const Vec3 limit = finer + (finer - fine);
  double last = 0;
  for (const double fraction : {0.5, 0.25, 0.125}) {
    const double error = (tip_after(duration, fraction, 0) - limit).norm();
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 1, 0.15);
    }
    last = error;
  }
}

TEST(StageOde, DampsByRateWhateverTheStep) {
  const auto speed_after = [](double dt, int steps) {
    Case c = floating(10);
    c.options.ode.damping_tangent = 2;
    c.options.ode.damping_normal = 5;
    for (Vec3& v : c.state.shape.r_dot) v = Vec3(1, 0, 1);
    run(dt, steps, c);
    return c.state.shape.r_dot[4];
  };
  const Vec3 coarse = speed_after(2e-3, 50), fine = speed_after(1e-3, 100);
  EXPECT_NEAR(coarse.x(), std::exp(-0.2), 1e-9);
  EXPECT_NEAR(coarse.z(), std::exp(-0.5), 1e-9);
  EXPECT_NEAR((coarse - fine).norm(), 0, 1e-9);
}

TEST(StageOde, DampsByTheFactorsOfThePaper) {
  Case c = floating(10);
  c.options.ode.damping = two_stage::Damping::per_step;
  c.options.substeps = false;
  for (Vec3& v : c.state.shape.r_dot) v = Vec3(1, 0, 1);
  run(1e-4, 3, c);
  EXPECT_NEAR(c.state.shape.r_dot[4].x(), std::pow(0.85, 3), 1e-9);
  EXPECT_NEAR(c.state.shape.r_dot[4].z(), std::pow(0.98, 3), 1e-9);
}

TEST(StabilityBound, IsThatOfTheParallelCoupling) {
  const Case c = cantilever(35, 0);
  const double l = c.ribbon.rest_length[0];
  const double expected =
      2 / std::sqrt(38.4 * 10 * c.ribbon.bending_stiffness / (c.ribbon.area_density * std::pow(l, 4)));
  EXPECT_NEAR(bound(c) / expected, 1, 0.02);  // the clamp's half cell counts a little more
  // The weight of the flat strip is the paper's alpha |K_D| / dim K.
  const double weight = energy::parallel_weight(
      c.ribbon, {energy::Elastic::wunderlich, 5, energy::StrainMeasure::printed}, c.state.shape, 10);
  EXPECT_NEAR(two_stage::rest_parallel_weight(c.ribbon, 10), weight, 1e-12 * weight);
}

/// Largest kinetic energy of a free strip pushed across its plane, in steps of a share of the bound.
double energy_beyond(double share) {
  Case c = floating(12);
  c.options.substeps = false;
  // In its plane a strip cannot bend: nothing but the coupling holds the nodes.
  for (std::size_t i = 0; i < c.state.shape.r.size(); ++i)
    c.state.shape.r_dot[i] = Vec3(0, i % 2 == 0 ? 1e-3 : -1e-3, 0);
  const double before = energy::kinetic_value(c.ribbon, c.state.shape);
  double largest = 0;
  for (int k = 0; k < 60; ++k) {
    const auto report = two_stage::step(c.ribbon, c.drive, c.options, share * bound(c), c.state, c.work);
    EXPECT_EQ(report.exceeds_bound, share > 1);
    if (!report.accepted) return HUGE_VAL;
    largest = std::max(largest, energy::kinetic_value(c.ribbon, c.state.shape) / before);
  }
  return largest;
}

TEST(StabilityBound, SeparatesStableFromUnstable) {
  EXPECT_LE(energy_beyond(0.95), 20);  // symplectic: bounded, though not constant
  EXPECT_GE(energy_beyond(1.05), 1e4);
}

TEST(StabilityBound, IsKeptBySubsteps) {
  Case c = cantilever(20, 0.2);
  const auto report = two_stage::step(c.ribbon, c.drive, c.options, 5 * bound(c), c.state, c.work);
  EXPECT_TRUE(report.accepted);
  EXPECT_FALSE(report.exceeds_bound);
  EXPECT_EQ(report.substeps, 6);
  EXPECT_NEAR(c.state.shape.time, 5 * bound(c), 1e-15);
}

TEST(StageOde, RefusesPinsThatAreTooFarApartAndLeavesTheState) {
  Case c = floating(10);
  two_stage::Support start, end;
  start.orientation = end.orientation = constraint::Orientation::free;
  end.node = 10;
  end.position = Vec3(0.33, 0, 0);
  c.drive.supports = {start, end};
  const two_stage::State before = c.state;
  const auto report = two_stage::step(c.ribbon, c.drive, c.options, 1e-3, c.state, c.work);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.failure.find("further apart"), std::string::npos) << report.failure;
  EXPECT_TRUE(same_bits(before, c.state));
}

TEST(StageOde, HoldsATautStripBetweenTwoPins) {
  Case c = floating(10);
  two_stage::Support start, end;
  start.orientation = end.orientation = constraint::Orientation::free;
  end.node = 10;
  end.position = Vec3(0.3, 0, 0);
  c.drive = {{start, end}, {}, Vec3(0, 0, -9.81)};
  const auto report = run(1e-3, 20, c);
  EXPECT_LE(report.constraints.max_length_error, 1e-9);
  EXPECT_NEAR(c.state.shape.r[5].z(), 0, 1e-5);
}

}  // namespace
}  // namespace wunderlich::testing
