// Whole steps: constraints at every step, loops of both parities, free twisted strips, repeatability, the printed form.
#include <gtest/gtest.h>

#include <cmath>

#include "two_stage/cases.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/geometry/topology.hpp"

namespace wunderlich::testing {
namespace {

double normalized_energy(const Case& c) {
  return energy::elastic_value(c.ribbon, c.options.model, c.state.shape) * c.ribbon.length /
         (c.ribbon.bending_stiffness * c.ribbon.width);
}

/// @eq Shen2015:alg1 @eq Shen2015:19
TEST(TwoStage, MeetsTheConstraintsAtEveryStepOfATiltedFall) {
  Case c = cantilever(30, 0.3);
  for (int k = 0; k < 60; ++k) {
    const auto report = run(1e-3, 1, c);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.constraints.max_binormal, 1e-6);
    EXPECT_LE(report.constraints.max_torsion_mismatch, 1e-6);
    EXPECT_LT(report.constraints.max_ruling_ratio, 1);
    EXPECT_LE(report.constraints.max_length_error, 1e-9);
    for (const Quat& q : c.state.shape.q) EXPECT_NEAR(q.norm(), 1, 1e-12);
  }
  EXPECT_LE(geometry::area_error(c.ribbon, c.state.shape), 1e-4);
  EXPECT_GT(c.state.shape.r.back().y(), 1e-3);  // it leaves the plane
  EXPECT_LT(c.state.shape.r.back().z(), -1e-2);
}

TEST(TwoStage, APlanarFallStaysInItsPlane) {
  Case c = cantilever(30, 0);
  run(1e-3, 60, c);
  EXPECT_LT(c.state.shape.r.back().z(), -1e-2);
  for (const Vec3& r : c.state.shape.r) EXPECT_EQ(r.y(), 0);
}

TEST(TwoStage, RunsAreTheSameBitForBit) {
  Case a = cantilever(20, 0.3), b = cantilever(20, 0.3);
  run(1e-3, 20, a);
  run(1e-3, 10, b);
  b.work = {};  // nothing but the state carries over
  run(1e-3, 10, b);
  EXPECT_TRUE(same_bits(a.state, b.state));
}

TEST(TwoStage, AMoebiusStripComesToRestAtItsEnergy) {
  Case c = loop(50, 1);
  disturb(0.8, c);
  run(1.4e-3, 350, c);
  const double disturbed = normalized_energy(c);
  EXPECT_GT(disturbed, 1.01 * 59.6506);  // so that what follows is a relaxation
  c.options.ode.damping_tangent = c.options.ode.damping_normal = 3;
  run(1.4e-3, 1500, c);
  EXPECT_NEAR(normalized_energy(c), 59.6506, 0.005 * 59.6506);
  EXPECT_LT(energy::kinetic_value(c.ribbon, c.state.shape), 1e-3);
  EXPECT_NEAR(geometry::topology(c.ribbon, c.state.shape).link, 0.5, 1e-6);
}

TEST(TwoStage, LoopsOfBothParitiesStayClosedAndRoundAtTheSeam) {
  for (const int half_twists : {0, 1}) {
    Case c = loop(24, half_twists);
    disturb(0.2, c);
    const auto report = run(5e-3, 60, c);
    const auto& shape = c.state.shape;
    EXPECT_TRUE(report.converged);
    EXPECT_LE((shape.r.back() - shape.r.front()).norm(), 0);
    EXPECT_EQ(shape.eta.back(), c.ribbon.seam_sign() * shape.eta.front());
    EXPECT_LE(report.constraints.max_binormal, 1e-6);
    EXPECT_LE(report.constraints.max_length_error, 1e-9);
    EXPECT_LE(geometry::area_error(c.ribbon, shape), 1e-3);
    EXPECT_NEAR(geometry::topology(c.ribbon, shape).link, 0.5 * half_twists, 1e-6);
    EXPECT_GT((shape.r[6] - loop(24, half_twists).state.shape.r[6]).norm(), 1e-3);
  }
}

/// A free helical strip: rulings at a slope, so that letting go untwists it. Turn of its last frame about its own
/// tangent in the first step [rad].
double first_turn(two_stage::TorsionalInertia inertia, double scale) {
  Case c = floating(20);
  geometry::Chain chain = geometry::straight_chain(c.ribbon, {Vec3::Zero(), c.state.shape.q[0]});
  for (std::size_t i = 1; i < 20; ++i) {
    chain.kappa[i] = 8;
    chain.eta[i] = 0.4 * std::sin(M_PI * static_cast<double>(i) / 20);
  }
  c.state = two_stage::start(c.ribbon, geometry::state_of(c.ribbon, chain, 0));
  c.options.inertia = inertia;
  c.options.inertia_scale = scale;
  const geometry::State before = c.state.shape;
  run(5e-5, 1, c);
  const Quat turn = before.q[19].conjugate() * c.state.shape.q[19];
  return std::abs(2 * std::atan2(turn.z(), turn.w()));
}

TEST(TorsionalInertiaInMotion, SlowsTheTurnOfAFreeStrip) {
  const double instant = first_turn(two_stage::TorsionalInertia::off, 1);
  const double slow = first_turn(two_stage::TorsionalInertia::physical, 1);
  const double light = first_turn(two_stage::TorsionalInertia::physical, 0.01);
  EXPECT_GT(instant, 1e-4);
  EXPECT_LT(slow, 0.5 * instant);
  EXPECT_GT(light, slow);
  EXPECT_LT(light, instant * 1.01);
}

TEST(TorsionalInertiaInMotion, KeepsAFreeSpinGoing) {
  // A straight strip turning about its own axis: the centerline is at rest, all motion is in the frames.
  Case c = floating(10);
  std::fill(c.state.spin.begin(), c.state.spin.end(), 20.0);
  const Quat before = c.state.shape.q[5];
  run(1e-3, 50, c);
  EXPECT_NEAR(before.angularDistance(c.state.shape.q[5]), 1.0, 1e-6);
  for (double spin : c.state.spin) EXPECT_NEAR(spin, 20, 1e-6);
}

TEST(PrintedForm, RunsInThePlaneAndReportsWhatItDid) {
  Case c = cantilever(12, 0);
  c.options = two_stage::printed_options();
  c.options.opt.accept_inexact = true;
  const double dt = 0.5 * two_stage::stable_step(c.ribbon, two_stage::rest_parallel_weight(c.ribbon, 10));
  const auto report = run(dt, 40, c);
  EXPECT_GT(report.iterations, 0);
  EXPECT_LE(report.constraints.max_length_error, 1e-9);
  EXPECT_LT(c.state.shape.r.back().z(), -1e-5);
}

TEST(Failure, LeavesTheStateAndSaysWhy) {
  Case c = cantilever(12, 0.3);
  run(1e-3, 5, c);
  c.options.opt.max_iterations = 0;
  const two_stage::State before = c.state;
  const auto report = two_stage::step(c.ribbon, c.drive, c.options, 1e-3, c.state, c.work);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.failure.find("stage opt"), std::string::npos);
  EXPECT_TRUE(same_bits(before, c.state));
}

TEST(Failure, NothingThatIsNotANumberIsAccepted) {
  Case c = cantilever(12, 0.3);
  c.drive.loads = {{5, Vec3(std::nan(""), 0, 0), Vec3::Zero()}};
  const two_stage::State before = c.state;
  EXPECT_FALSE(two_stage::step(c.ribbon, c.drive, c.options, 1e-3, c.state, c.work).accepted);
  EXPECT_TRUE(same_bits(before, c.state));
}

TEST(Failure, AnEndFrameWithoutAClampIsRefused) {
  Case c = cantilever(12, 0);
  c.drive.supports.clear();
  EXPECT_FALSE(two_stage::step(c.ribbon, c.drive, c.options, 1e-3, c.state, c.work).accepted);
}

}  // namespace
}  // namespace wunderlich::testing
