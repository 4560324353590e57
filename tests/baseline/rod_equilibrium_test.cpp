// Equilibria of rods against closed forms and an independent code.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/rods.hpp"
#include "wunderlich/geometry/topology.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

void expect_order(const std::vector<double>& errors, double order) {
  for (std::size_t k = 1; k < errors.size(); ++k) {
    EXPECT_GE(std::log2(errors[k - 1] / errors[k]), order) << errors[k - 1] << " " << errors[k];
  }
}

geometry::RibbonSpec strip(int segments) {
  geometry::RibbonSpec spec;
  spec.segments = segments;
  return spec;
}

rod::State perturbed(rod::State state, double amount) {
  for (Vec3& x : state.x) x.z() += amount * std::sin(kPi * x.x());
  return state;
}

// The figures are those of an independent C++ rod (separate curvatures, exact Hessians) that is loaded in 20 equal
// steps, supports first and all else after them. Such rods have many equilibria close to one another.
// @eq Bergou2008:2
TEST(RodEquilibrium, ProblemTAgreesWithAnIndependentCode) {
  for (const auto& [nodes, expected] : {std::pair{50, 0.1513}, {100, 0.1396}}) {
    const geometry::RibbonSpec spec = problem_t_spec(nodes);
    Rod sample = rod::make_rod(spec, rod::physical(spec, 0.3, 1e-3));
    sample.bending = rod::Bending::separate;
    rod::Options options;
    options.predict = false;
    const PathEnd end =
        along_path(sample, problem_t_surroundings(nodes), perturbed(rod::straight_state(sample), 1e-4), 20, options);
    ASSERT_TRUE(end.done) << rod::outcome_name(end.last.outcome);
    EXPECT_EQ(end.last.negative_modes, 0);
    EXPECT_NEAR(end.energy, expected, 0.02 * expected) << nodes;
  }
}

TEST(RodEquilibrium, AveragedCurvatureTakesFewerNodes) {
  // What is clamped is one edge at either end; energies of the length between are compared.
  std::vector<double> energy;
  for (int nodes : {26, 51, 101}) {
    const geometry::RibbonSpec spec = problem_t_spec(nodes);
    const Rod sample = rod::make_rod(spec, rod::physical(spec, 0.3, 1e-3));
    const PathEnd end =
        along_path(sample, problem_t_surroundings(nodes), perturbed(rod::straight_state(sample), 1e-4), 20);
    ASSERT_TRUE(end.done);
    energy.push_back(end.energy);
  }
  EXPECT_LE(std::abs(energy[0] - energy[2]), 0.05 * energy[2]);
  EXPECT_LE(std::abs(energy[1] - energy[2]), 0.02 * energy[2]);
}

// Straight it has no strain: out of balance is all that its nodes weigh, and a torque about it by the width.
TEST(RodEquilibrium, OutOfBalanceIsWhatNothingBears) {
  geometry::RibbonSpec spec = strip(20);
  spec.area_density = 3;
  const Rod sample = rod::make_rod(spec, rod::Stiffness{1, 1, 1, 1});
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0)};
  surroundings.gravity = Vec3(3, 0, -4);
  const double weight = spec.area_density * spec.width * spec.length / 20 * 5;
  rod::Workspace work;
  const rod::State state = rod::straight_state(sample);
  EXPECT_NEAR(rod::net_force(sample, surroundings, state, work), weight, 1e-12);
  const double torque = 2 * weight * spec.width;
  surroundings.loads = {{20, constraint::LoadFrame::space, {{0, Vec3::Zero(), Vec3(-torque, 0, 0)}}}};
  EXPECT_NEAR(rod::net_force(sample, surroundings, state, work), 2 * weight, 1e-12);
  surroundings.loads = {};
  surroundings.gravity.setZero();
  EXPECT_NEAR(rod::net_force(sample, surroundings, state, work), 0, 1e-12);
}

// A clamp at a place that has no exact number stands: it is not carried along for its rounding.
TEST(RodEquilibrium, AClampThatStandsDoesNotMove) {
  const Rod sample = rod::make_rod(strip(20), rod::physical(strip(20), 0.3, 1e-3));
  const Vec3 place(0.1, 0.7, -1.3);
  const Quat frame = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized())) * straight_frame();
  rod::State state = rod::straight_state(sample);
  const Mat3 turn = (frame * straight_frame().conjugate()).toRotationMatrix();
  for (Vec3& x : state.x) x = place + turn * x;
  for (Vec3& m1 : state.reference) m1 = turn * m1;
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {place, frame}, place, 0)};
  rod::Unknowns unknowns;
  rod::hold(sample, surroundings.supports, state, 0, true, unknowns);
  EXPECT_FALSE(rod::supports_moved(unknowns));
  state.x[1].z() += 1e-10;
  rod::hold(sample, surroundings.supports, state, 0, true, unknowns);
  EXPECT_TRUE(rod::supports_moved(unknowns));
}

TEST(RodEquilibrium, TwistIsUniform) {
  const geometry::RibbonSpec spec = strip(20);
  const Rod sample = rod::make_rod(spec, rod::Stiffness{1e4, 1, 10, 0.7});
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0),
                           clamp(20, {Vec3(1, 0, 0), straight_frame()}, Vec3(1, 0, 0), 1.5 * kPi)};
  const PathEnd end = along_path(sample, surroundings, rod::straight_state(sample), 10);
  ASSERT_TRUE(end.done);
  const double twisted = 1 - spec.length / spec.segments;  // between the middles of the clamped edges
  for (std::size_t i = 1; i < sample.edges(); ++i) {
    EXPECT_NEAR(rod::strain(sample, end.state, i).twist, 1.5 * kPi / twisted, 1e-8);
    EXPECT_NEAR(rod::strain(sample, end.state, i).soft, 0, 1e-8);
  }
  EXPECT_NEAR(end.energy, 0.5 * 0.7 * 2.25 * kPi * kPi / twisted, 1e-8);
}

TEST(RodEquilibrium, RingHasItsEnergyToSecondOrder) {
  std::vector<double> errors;
  for (int n : {12, 24, 48}) {
    geometry::RibbonSpec spec = strip(n);
    spec.closure = geometry::Closure::loop;
    const Rod sample = rod::make_rod(spec, rod::Stiffness{1e6, 3, 20, 3});
    rod::State start = rod::ring_state(sample);
    for (Vec3& x : start.x) x.x() *= 1.2;
    const PathEnd end = along_path(sample, {}, start, 1);
    ASSERT_TRUE(end.done) << rod::outcome_name(end.last.outcome);
    errors.push_back(std::abs(end.energy - 2 * kPi * kPi * 3));
  }
  expect_order(errors, 1.8);
}

/// End of a cantilever of length 1 whose end is pulled sideways by `load` times its stiffness: theta'' = -load cos
/// theta, by shooting from the free end with a fourth-order method.
Vec2 elastica_end(double load) {
  struct Point {
    double angle, slope, x, y;
  };
  const auto base = [&](double end_angle) {
    const int steps = 2000;
    const double h = 1.0 / steps;
    Point p{end_angle, 0, 0, 0};
    const auto rate = [&](const Point& q) {
      return Point{-q.slope, load * std::cos(q.angle), std::cos(q.angle), std::sin(q.angle)};
    };
    const auto plus = [](const Point& q, double f, const Point& r) {
      return Point{q.angle + f * r.angle, q.slope + f * r.slope, q.x + f * r.x, q.y + f * r.y};
    };
    for (int i = 0; i < steps; ++i) {
      const Point a = rate(p), b = rate(plus(p, h / 2, a)), c = rate(plus(p, h / 2, b)), d = rate(plus(p, h, c));
      p = plus(plus(plus(plus(p, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
    }
    return p;
  };
  double low = 0, high = kPi / 2;
  for (int i = 0; i < 60; ++i) (base(0.5 * (low + high)).angle > 0 ? high : low) = 0.5 * (low + high);
  const Point p = base(low);
  return {p.x, p.y};
}

TEST(RodEquilibrium, CantileverIsTheElasticaToSecondOrder) {
  EXPECT_NEAR(elastica_end(1)[1], 0.30172, 1e-5);  // Mattiasson 1981, table 1
  const double load = 4;
  std::vector<double> errors;
  for (int n : {8, 16, 32}) {
    // The first edge is clamped, so that the rod bends from its middle on; from there its length is 1.
    geometry::RibbonSpec spec = strip(n);
    spec.length = n / (n - 0.5);
    const Rod sample = rod::make_rod(spec, rod::Stiffness{1e7, 2, 50, 1});
    constraint::Surroundings surroundings;
    surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0)};
    surroundings.loads = {
        {n, constraint::LoadFrame::space, {{0, Vec3::Zero(), Vec3::Zero()}, {1, Vec3(0, 0, 2 * load), Vec3::Zero()}}}};
    const PathEnd end = along_path(sample, surroundings, rod::straight_state(sample), 4);
    ASSERT_TRUE(end.done) << rod::outcome_name(end.last.outcome);
    const Vec3 tip = end.state.x.back() - Vec3(0.5 * spec.length / n, 0, 0);
    errors.push_back((Vec2(tip.x(), tip.z()) - elastica_end(load)).norm());
  }
  expect_order(errors, 1.8);
}

TEST(RodEquilibrium, HelixHasItsEnergyToSecondOrder) {
  const double kappa = 3, tau = 2, k2 = kappa * kappa + tau * tau, radius = kappa / k2, rise = tau / k2;
  std::vector<double> averaged, separate;
  for (int n : {20, 40, 80}) {
    Rod sample = rod::make_rod(strip(n), rod::Stiffness{1e3, 2, 50, 0.7});
    geometry::State helix;
    const double w = std::sqrt(k2);
    for (int i = 0; i <= n; ++i) {
      const double a = w * i / n;
      helix.r.emplace_back(radius * std::cos(a), radius * std::sin(a), rise * a);
      helix.r_dot.emplace_back(Vec3::Zero());
      if (i == n) break;
      const double m = w * (i + 0.5) / n;
      Mat3 frame;
      frame.col(0) = Vec3(-std::cos(m), -std::sin(m), 0);
      frame.col(2) = w * Vec3(-radius * std::sin(m), radius * std::cos(m), rise);
      frame.col(1) = frame.col(2).cross(frame.col(0));
      helix.q.emplace_back(frame);
    }
    const auto energy = [&] { return rod::elastic_energy(sample, rod::state_from(sample, helix)); };
    // Nodes within the rod only: n - 1 cells of the n.
    const double exact = 0.5 * (2 * kappa * kappa + 0.7 * tau * tau) * (n - 1) / n;
    averaged.push_back(std::abs(energy().sum() - exact));
    EXPECT_LE(energy().hard, 1e-12);
    EXPECT_NEAR(rod::strain(sample, rod::state_from(sample, helix), 3).soft, kappa, 0.1 * kappa);
    EXPECT_NEAR(rod::strain(sample, rod::state_from(sample, helix), 3).twist, tau, 0.1 * tau);
    sample.bending = rod::Bending::separate;
    separate.push_back(std::abs(energy().sum() - exact));
    // The section turns by tau/n from edge to edge, and bends as if it were stiffer by hard (tau/n)^2/4.
    EXPECT_NEAR(energy().hard, 0.5 * 50 * kappa * kappa * tau * tau / (4.0 * n * n), 0.1 * energy().hard);
  }
  expect_order(averaged, 1.8);
  expect_order(separate, 1.8);
}

/// What the geometry of ribbons says of a rod's frames.
geometry::State as_ribbon_state(const Rod& sample, const rod::State& state) {
  geometry::State out;
  out.r = state.x;
  for (std::size_t j = 0; j < sample.edges(); ++j) {
    const rod::Section s = rod::section(state, j);
    Mat3 frame;
    frame << s.m1, s.m2, s.m3;
    out.q.emplace_back(frame);
  }
  out.eta.assign(sample.nodes(), 0.0);
  return out;
}

TEST(RodEquilibrium, LoopsKeepTheirHalfTwists) {
  for (int half_twists : {1, 2, -1}) {
    geometry::RibbonSpec spec = strip(40);
    spec.closure = geometry::Closure::loop;
    spec.half_twists = half_twists;
    const Rod sample = rod::make_rod(spec, rod::physical(spec, 0.3, 0.01));
    for (std::size_t i = 1; i <= sample.edges(); ++i) {  // the seam's hinge like any other
      EXPECT_NEAR(rod::strain(sample, rod::ring_state(sample), i).twist, kPi * half_twists, 1e-9);
    }
    const PathEnd end = along_path(sample, {}, rod::ring_state(sample), 1);
    ASSERT_TRUE(end.done) << rod::outcome_name(end.last.outcome) << " " << end.last.iterations;
    EXPECT_EQ(end.last.negative_modes, 0);
    const geometry::State shape = as_ribbon_state(sample, end.state);
    EXPECT_NEAR(geometry::topology(geometry::make_ribbon(spec), shape).link, 0.5 * half_twists, 1e-9);
    EXPECT_LE((end.state.x.front() - end.state.x.back()).norm(), 0);
    // A strip bends out of the plane to twist less than the flat ring.
    EXPECT_LT(end.energy, rod::elastic_energy(sample, rod::ring_state(sample)).sum());
    // The mirror image has the same energy, and state_from makes the same rod of the same frames.
    EXPECT_NEAR(rod::elastic_energy(sample, rod::state_from(sample, shape)).sum(), end.energy, 1e-9 * end.energy);
  }
}

TEST(RodEquilibrium, ClampsLeaveTheAxesFreeThatTheyName) {
  const geometry::RibbonSpec spec = strip(20);
  const Rod sample = rod::make_rod(spec, rod::Stiffness{100, 1, 10, 0.7});
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0),
                           clamp(20, {Vec3(1, 0, 0), straight_frame()}, Vec3(1, 0, 0), 1)};
  surroundings.supports[1].hold_position = {false, true, true};
  surroundings.loads = {{20, constraint::LoadFrame::space, {{0, Vec3(5, 3, 0), Vec3::Zero()}}}};
  const PathEnd end = along_path(sample, surroundings, rod::straight_state(sample), 4);
  ASSERT_TRUE(end.done);
  // Every edge but the clamped two stretches by 5/100.
  EXPECT_NEAR(end.state.x.back().x(), 1 + 18.0 / 20 * 0.05, 1e-9);
  EXPECT_NEAR(end.state.x.back().y(), 0, 1e-12);
}

}  // namespace
}  // namespace wunderlich::testing
