// A heavy flexible strip over a fixed cylinder: friction holds it up to a length that hangs on one side.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81, kRadius = 0.05, kShorter = 0.05;  // m
constexpr int kFolds = 24;                                          // of the half circle it lies on

/// Hanging length from which on it slips: the tension T grows by mu times the pressure, T/R + rho g sin(angle) over
/// the half circle, and by the weight.
double longest_held(double shorter, double radius, double friction) {
  const double grown = std::exp(friction * kPi);
  return shorter * grown + radius * 2 * friction / (1 + friction * friction) * (1 + grown);
}

struct Capstan {
  Motion motion;
  double radius;  ///< of the strip's middle surface [m]
};

/// At rest, folded round half of the cylinder by facets that touch in their middles; soft enough not to stand off.
/// What hangs on the longer side is `share` of the longest that friction holds.
Capstan capstan(double friction, double share) {
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -kGravity);
  surroundings.contact.distance = kRadius / 200;
  constraint::Obstacle cylinder;
  cylinder.shape = contact::Cylinder{kRadius, 1};
  cylinder.friction = friction;
  cylinder.motion.keys = {{0, {Vec3::Zero(), math::exp_map(Vec3(kPi / 2, 0, 0))}, 0}};
  surroundings.obstacles = {cylinder};
  geometry::RibbonSpec spec;
  spec.width = 0.01;
  spec.bending_stiffness = 1e-7;
  spec.area_density = 0.1;
  // How far it floats needs the margin, which needs the strip's segments.
  solver::ContactProblem contact;
  double radius = kRadius;
  for (int pass = 0; pass < 2; ++pass) {
    const double facet = 2 * radius * std::tan(kPi / (2 * kFolds));
    const double longer = share * longest_held(kShorter, radius, friction);
    spec.spacing.clear();
    const auto add = [&](double length) {
      const auto count = static_cast<std::size_t>(std::ceil(length / facet));
      for (std::size_t i = 0; i < count; ++i) spec.spacing.push_back(length / static_cast<double>(count));
    };
    add(kShorter - 0.5 * facet);
    for (int i = 0; i <= kFolds; ++i) spec.spacing.push_back(facet);
    add(longer - 0.5 * facet);
    spec.segments = static_cast<int>(spec.spacing.size());
    spec.length = kShorter + longer + kFolds * facet;
    solver::place_solids(geometry::make_ribbon(spec), surroundings, 0, contact);
    const double side = facet / contact.along, cell = spec.width / contact.across;
    if (pass == 0) radius += (side * side + cell * cell) / (8 * kRadius) + 0.89 * contact.distance;
  }
  Motion m = make_motion(spec, surroundings);
  m.options.integrator = implicit::Integrator::euler;
  const geometry::Ribbon& ribbon = m.path.ribbon;
  const Pose base{Vec3(-radius, 0, -kShorter), math::exp_map(Vec3(0, -kPi / 2, 0)) * straight_frame()};
  geometry::Chain chain = geometry::straight_chain(ribbon, base);
  std::size_t node = 1;
  while (ribbon.node_u[node] < kShorter) ++node;  // the first fold is half a facet above the axis
  for (std::size_t i = 0; i < kFolds; ++i) chain.kappa[node + i] = kPi / kFolds / ribbon.hinge_length[node + i];
  geometry::Kinematics k;
  geometry::forward_kinematics(ribbon, chain, k);
  if (k.r.back().x() < 0) {
    for (double& kappa : chain.kappa) kappa = -kappa;
  }
  start(chain, m);
  return {std::move(m), radius};
}

/// Speed at which the longer side sinks [m/s].
double speed(const Motion& m) { return -implicit::shape_of(m.path, m.state).r_dot.back().z(); }

TEST(Capstan, SlipsFromTheLengthThatFrictionDoesNotHold) {
  for (const double friction : {0.2, 0.4}) {
    for (const double share : {0.98, 1.02}) {
      Capstan strip = capstan(friction, share);
      Motion& m = strip.motion;
      double earlier = 0;
      const int steps = 200;
      for (int i = 1; i <= steps; ++i) {
        ASSERT_TRUE(move_to(1e-3 * i, m)) << m.failure;
        if (i == steps / 2) earlier = speed(m);
      }
      show("speed at " + std::to_string(share) + " of the threshold [m/s]", speed(m), 1e-3);
      if (share < 1) {
        EXPECT_LT(speed(m), 1e-3);  // creeps
      } else {
        EXPECT_GT(speed(m), 2e-3);
        EXPECT_GT(speed(m), 1.5 * earlier);  // and faster and faster
      }
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
