// Strips that fall on solids: they stay out, come to rest on their weight, and no step carries them through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "implicit/drops.hpp"
#include "solver/paths.hpp"
#include "wunderlich/solver/chain_contact.hpp"

namespace wunderlich::testing {
namespace {

TEST(Contact, ADrapeStaysOutAtAnyStep) {
  for (const double turn : {0.0, 0.5}) {
    for (const double dt : {1e-3, 2e-3, 5e-3, 1e-2}) {
      if (is_slow_build() && dt < 5e-3) continue;
      SCOPED_TRACE(dt);
      Motion m = drop(2e-5, 20, {solid(contact::Cylinder{0.03, 1e9}, axis_y(0.15, -0.05, turn))}, along_x(0, 0),
                      Vec3(0, 0, -kGravity));
      const double least = lowest_clearance(is_slow_build() ? 0.1 : 0.4, dt, m);
      show("smallest distance of a drape", least, 0);
      EXPECT_GT(least, 0);
      EXPECT_LT(least, 1e-3);  // it got there
    }
  }
}

/// At rest on a plane the barrier's forces add up to the weight.
TEST(Contact, ReactionIsTheWeight) {
  Motion m = drop(1e-2, 20, {solid(contact::HalfSpace{}, along_x(0, 0))}, along_x(0, 9.5e-4), Vec3(0, 0, -kGravity));
  m.path.surroundings.obstacles[0].motion.keys[0].pose.frame = Quat::Identity();
  m.options.integrator = implicit::Integrator::euler;
  start(geometry::straight_chain(m.path.ribbon, along_x(0, 9.5e-4)), m);
  for (int i = 1; i <= 400; ++i) ASSERT_TRUE(move_to(5e-3 * i, m)) << m.failure;
  const Vec3 push = push_of(m.path, m.state.strips[0].path.t, m.state.strips[0].path.chain);
  const double weight = 0.3 * 0.03 * 0.1 * kGravity;
  show("reaction over weight, less 1", std::abs(push.z() / weight - 1), 1e-6);
  EXPECT_NEAR(push.z() / weight, 1, 1e-6);
  EXPECT_LT(push.head<2>().norm() / weight, 1e-6);
}

/// Statics: a strip leaves its clamp level and lies down on a plane below.
TEST(Contact, AClampAndASolidShareTheWeight) {
  geometry::RibbonSpec spec = sheet(2e-5, true);
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -kGravity);
  surroundings.supports = {clamp(0, along_x(0, 0))};
  surroundings.obstacles = {solid(contact::HalfSpace{}, {Vec3(0, 0, -0.02), Quat::Identity()})};
  surroundings.contact.distance = spec.width / 30;
  const PathEnd end = run_path(spec, surroundings, {});
  ASSERT_TRUE(end.done) << end.failure;
  solver::NewtonWorkspace work;
  const solver::EndReactions reactions = solver::end_reactions(end.path, end.at, work);
  const Vec3 push = push_of(end.path, end.at.t, end.at.chain);
  const double weight = spec.length * spec.width * spec.area_density * kGravity;
  EXPECT_GT(push.z() / weight, 0.3);
  EXPECT_GT(reactions.force[0].z() / weight, 0.1);
  const double error = ((reactions.force[0] + push) / weight - Vec3::UnitZ()).norm();
  show("clamp and solid together over weight, less 1", error, 1e-6);
  EXPECT_LT(error, 1e-6);
}

/// With a thickness an equilibrium keeps it, and what it reports is the distance beyond: all that the facets have left,
/// less at most the margin for what lies between the solver's points.
TEST(Contact, EquilibriaReportTheDistanceBeyondTheThickness) {
  for (const contact::Shape& shape :
       {contact::Shape{contact::HalfSpace{}}, contact::Shape{contact::Box{{1, 1, 0.1}}}}) {
    geometry::RibbonSpec spec = sheet(2e-5, true);
    constraint::Surroundings surroundings;
    surroundings.gravity = Vec3(0, 0, -kGravity);
    surroundings.supports = {clamp(0, along_x(0, 0))};
    const double top = std::holds_alternative<contact::Box>(shape) ? 0.1 : 0;
    surroundings.obstacles = {solid(shape, {Vec3(0, 0, -0.02 - top), Quat::Identity()})};
    surroundings.contact.distance = spec.width / 30;
    surroundings.contact.thickness = 2e-3;
    const PathEnd end = run_path(spec, surroundings, {});
    ASSERT_TRUE(end.done) << end.failure;
    double lowest = 1;  // on level faces nothing is lower than a corner
    for (std::size_t s = 0; s < end.shape.q.size(); ++s) {
      const Mat3 frame = end.shape.q[s].toRotationMatrix();
      for (const std::size_t node : {s, s + 1}) {
        for (const double v : {-0.5 * spec.width, 0.5 * spec.width}) {
          const Vec3 corner = end.shape.r[node] + v * (frame.col(1) + end.shape.eta[node] * frame.col(2));
          lowest = std::min(lowest, corner.z() + 0.02);
        }
      }
    }
    const double beyond = lowest - surroundings.contact.thickness;
    show("distance beyond the thickness, equilibrium", beyond, 0);
    EXPECT_GT(beyond, 0);
    EXPECT_LT(beyond, surroundings.contact.distance);  // it lies there
    EXPECT_GT(end.at.nearest, 0);
    EXPECT_LT(end.at.nearest, beyond + 1e-9);
  }
}

/// Speed along the slope, down it, after 0.5 s on a plane of slope tan(alpha) with friction.
double slide(double slope, double friction) {
  const double alpha = std::atan(slope);
  constraint::Obstacle plane = solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()});
  plane.friction = friction;
  // The plane is level and gravity leans: down the slope is (1, 1, 0)/sqrt(2), aslant to the strip.
  const Vec3 down = Vec3(1, 1, 0).normalized();
  Motion m =
      drop(1e-2, 12, {plane}, along_x(0, 9e-4), kGravity * (std::sin(alpha) * down - std::cos(alpha) * Vec3::UnitZ()));
  m.options.integrator = implicit::Integrator::euler;
  const double dt = 2.5e-3;
  for (int i = 1; i <= 200; ++i) EXPECT_TRUE(move_to(dt * i, m)) << m.failure;
  return implicit::shape_of(m.path, m.state).r_dot[6].dot(down);
}

/// It slips if and only if tan(alpha) > mu; what creeps below that is slower than 1 mm/s.
TEST(Contact, AStripSlipsOnASlopeAsCoulombSays) {
  for (const double friction : {0.1, 0.3, 0.6}) {
    const double held = slide(0.99 * friction, friction), slips = slide(1.01 * friction, friction);
    const double steeper = slide(1.5 * friction, friction), alpha = std::atan(1.5 * friction);
    show("creep below the threshold [m/s]", held, 1e-3);
    show("slip above it [m/s]", slips, 1e-3);
    EXPECT_LT(held, 1e-3);
    EXPECT_GT(slips, 1e-3);
    const double free = 0.5 * kGravity * (std::sin(alpha) - friction * std::cos(alpha));
    EXPECT_NEAR(steeper, free, 0.03 * free);
  }
}

/// Against a thin rod, at a speed that goes 20 diameters in a step.
TEST(Contact, NothingIsLeaptOver) {
  if (is_slow_build()) GTEST_SKIP() << "takes a minute there";
  Motion m = drop(1e-3, 20, {solid(contact::Capsule{1e-3, 1}, axis_y(0.15, -0.1, 0))}, along_x(0, 0), Vec3::Zero());
  geometry::State shape = geometry::state_of(m.path.ribbon, m.state.strips[0].path.chain, 0);
  for (Vec3& v : shape.r_dot) v = Vec3(0, 0, -8);
  start(shape, Vec3::Zero(), m);
  const double least = lowest_clearance(0.04, 5e-3, m);
  EXPECT_GT(least, 0);
  double top = -1, bottom = 1;
  for (const Vec3& r : implicit::shape_of(m.path, m.state).r) {
    top = std::max(top, r.z());
    bottom = std::min(bottom, r.z());
  }
  EXPECT_GT(top, -0.1);  // it hangs over the rod ...
  EXPECT_LT(bottom, -0.2);
}

/// However far rulings lean: what is reported is a bound from below of a distance that is known, between points as
/// well.
TEST(Contact, FacetsAreClearBetweenPointsHoweverRulingsLean) {
  geometry::RibbonSpec spec = sheet(1e-3, false);
  spec.segments = 20;  // half as long as wide: rims shrink to nothing where rulings differ by 1
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  constraint::Surroundings surroundings;
  const double d = surroundings.contact.distance = spec.width / 30;
  surroundings.contact.thickness = 2e-4;
  std::mt19937_64 engine(7);
  const auto in = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  double worst = -1e9, least = 1e9;
  for (int i = 0; i < 6000; ++i) {
    const double lean = 2 * (i % 3), radius = std::exp(in(std::log(1e-3), std::log(0.1))), clear = 1e-3 * d;
    geometry::Chain chain = geometry::straight_chain(ribbon, along_x(0, 0));
    for (double& eta : chain.eta) eta = lean + in(-0.5, 0.5);
    geometry::Kinematics k;
    geometry::forward_kinematics(ribbon, chain, k);
    // Above a point of the third facet, touching it but for `clear`; a rod is level.
    const double f = in(0, 1), v = spec.width * in(-0.5, 0.5), eta = (1 - f) * chain.eta[2] + f * chain.eta[3];
    const Vec3 point =
        k.r[2] + f * ribbon.rest_length[2] * k.frame[2].col(2) + v * (k.frame[2].col(1) + eta * k.frame[2].col(2));
    Pose pose = axis_y(0, 0, in(0, 3));
    pose.position = point + (radius + surroundings.contact.thickness + clear) * k.frame[2].col(0);
    const contact::Shape rod = contact::Capsule{radius, 0.1}, ball = contact::Sphere{radius};
    surroundings.obstacles = {solid(i % 2 == 0 ? rod : ball, pose)};
    solver::ContactProblem problem;
    solver::place_solids(ribbon, surroundings, 0, problem);
    solver::ContactPoints points;
    solver::find_points(ribbon, problem, chain, k, points);
    const double off = clear - smallest_distance(problem, points);
    least = std::min(least, off);
    if (lean == 0) worst = std::max(worst, off);
  }
  show("least distance over what is reported", least, 0);
  show("the most, over the barrier's distance, rulings up to 1/2", worst / d, 2);
  EXPECT_GE(least, -1e-12);
  EXPECT_LT(worst, 2 * d);  // half of it where rims are as long as the strip; they are up to twice as long
}

/// A solid that moves pushes the strip along.
TEST(Contact, AMovingSolidPushes) {
  constraint::Obstacle wall = solid(contact::Sphere{0.05}, {Vec3(0.15, 0, -0.06), Quat::Identity()});
  wall.motion.keys.push_back({0.1, {Vec3(0.15, 0, 0.06), Quat::Identity()}, 0});
  Motion m = drop(1e-3, 20, {wall}, along_x(0, 0), Vec3::Zero());
  const double least = lowest_clearance(0.12, 2e-3, m);
  EXPECT_GT(least, 0);
  EXPECT_GT(implicit::shape_of(m.path, m.state).r[10].z(), 0.1);
}

}  // namespace
}  // namespace wunderlich::testing
