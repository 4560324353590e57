// Several strips in one step: what they do to one another comes in pairs, and nothing goes through anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "implicit/motions.hpp"
#include "support/crossings.hpp"

namespace wunderlich::testing {
namespace {

using std::numbers::pi;

/// Strips that feel themselves and one another.
struct Motions {
  std::vector<solver::PathProblem> paths;
  implicit::Options options;
  implicit::State state;
  implicit::Workspace work;
  int steps = 0, iterations = 0;
};

constraint::Surroundings touching(double distance) {
  constraint::Surroundings surroundings;
  surroundings.contact = {distance, 0, true};
  return surroundings;
}

/// Halved where it is not accepted.
bool move_to(double t1, Motions& m, int halvings = 0) {
  const double t0 = m.state.time();
  const auto report = implicit::step(m.paths, m.options, t1, halvings, m.state, m.work);
  m.iterations += report.iterations;
  if (report.accepted) return ++m.steps, true;
  if (halvings == 8) return ADD_FAILURE() << report.failure, false;
  return move_to(0.5 * (t0 + t1), m, halvings + 1) && move_to(t1, m, halvings + 1);
}

int crossings_of(const Motions& m) {
  std::vector<geometry::Kinematics> k(m.paths.size());
  std::vector<solver::StripPlace> places;
  for (std::size_t i = 0; i < m.paths.size(); ++i) {
    geometry::forward_kinematics(m.paths[i].ribbon, m.state.strips[i].path.chain, k[i]);
    places.push_back({m.paths[i].ribbon, m.state.strips[i].path.chain, k[i]});
  }
  return crossings(places);
}

implicit::Momentum momentum_of(const Motions& m, std::size_t strip) {
  const implicit::StripState& s = m.state.strips[strip];
  return implicit::momentum(m.paths[strip].ribbon, m.options.kinetic, s.points, s.path.chain.eta);
}

double energy_of(const Motions& m) {
  double energy = m.state.elastic;
  for (std::size_t i = 0; i < m.paths.size(); ++i) {
    const implicit::StripState& s = m.state.strips[i];
    energy += implicit::kinetic_energy(m.paths[i].ribbon, m.options.kinetic, s.points, s.path.chain.eta);
  }
  return energy;
}

/// Two sheets one above the other and square to each other, of which the lower one moves up.
Motions collision(double step_tolerance) {
  Motions m;
  std::vector<geometry::State> shapes;
  for (const int i : {0, 1}) {
    const geometry::RibbonSpec spec = sheet(i == 0 ? 2e-4 : 5e-5, false);
    m.paths.push_back(solver::make_path(geometry::make_ribbon(spec), touching(1e-3), {}));
    const geometry::Ribbon& ribbon = m.paths.back().ribbon;
    // Beside its middle, so that both turn.
    const Quat turn = i == 0 ? Quat::Identity() : Quat(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitZ()));
    const Vec3 start = i == 0 ? Vec3(-0.15, 0, 0) : Vec3(0.03, -0.12, 0.01);
    shapes.push_back(geometry::straight_state(ribbon));
    for (Vec3& r : shapes.back().r) r = start + turn * r;
    for (Quat& q : shapes.back().q) q = turn * q;
    for (Quat& q : shapes.back().end_frame) q = turn * q;
    for (Vec3& v : shapes.back().r_dot) v = i == 0 ? Vec3(0, 0, 0.5) : Vec3::Zero();
  }
  m.options.tolerance = step_tolerance;
  const std::vector<Vec3> spins(2, Vec3::Zero());
  m.state = implicit::start(m.paths, m.options, shapes, spins, m.work);
  return m;
}

TEST(SeveralStrips, ThatCollideKeepTheirMomenta) {
  Motions m = collision(1e-10);
  const implicit::Momentum before = momentum_of(m, 0);
  const double energy = energy_of(m);
  double worst_linear = 0, worst_angular = 0, worst_energy = 0;
  for (int i = 1; i <= 60; ++i) {
    ASSERT_TRUE(move_to(1e-3 * i, m));
    ASSERT_EQ(crossings_of(m), 0) << "at step " << i;
    const implicit::Momentum a = momentum_of(m, 0), b = momentum_of(m, 1);
    worst_linear = std::max(worst_linear, (a.linear + b.linear - before.linear).norm() / before.linear.norm());
    const double arm = 0.15 * before.linear.norm();
    worst_angular = std::max(worst_angular, (a.angular + b.angular - before.angular).norm() / arm);
    worst_energy = std::max(worst_energy, energy_of(m) / energy - 1);
  }
  // The upper sheet has taken over momentum, and both turn.
  EXPECT_GT(momentum_of(m, 1).linear.z(), 0.2 * before.linear.z());
  EXPECT_GT(momentum_of(m, 1).angular.norm(), 1e-3 * before.linear.norm());
  show("collision_linear_momentum", worst_linear, 1e-9);
  show("collision_angular_momentum", worst_angular, 3e-3);
  show("collision_energy_growth", worst_energy, 1e-3);
  EXPECT_LT(worst_linear, 1e-9);
  EXPECT_LT(worst_angular, 3e-3);
  EXPECT_LT(worst_energy, 1e-3);
}

/// Gauss's integral over two closed polygons, each pair of segments by its solid angle: how often one goes through the
/// other. (Klenin and Langowski 2000)
double linking(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    for (std::size_t j = 0; j + 1 < b.size(); ++j) {
      const Vec3 corner[4] = {b[j] - a[i], b[j + 1] - a[i], b[j + 1] - a[i + 1], b[j] - a[i + 1]};
      // The quadrangle of directions as two triangles on the sphere (van Oosterom and Strackee).
      for (const auto& t : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        const Vec3 x = corner[t[0]].normalized(), y = corner[t[1]].normalized(), z = corner[t[2]].normalized();
        sum += 2 * std::atan2(x.dot(y.cross(z)), 1 + x.dot(y) + y.dot(z) + z.dot(x));
      }
    }
  }
  return sum / (4 * pi);
}

/// Two rings, one through the other; one is held, the other falls into it and hangs.
TEST(SeveralStrips, LinkedRingsStayLinked) {
  const int count = is_slow_build() ? 40 : 150;
  Motions m;
  std::vector<geometry::State> shapes;
  for (const int i : {0, 1}) {
    geometry::RibbonSpec spec;
    spec.length = 0.3, spec.width = 0.02, spec.segments = 30;
    spec.bending_stiffness = 5e-4, spec.area_density = 0.16;
    spec.closure = geometry::Closure::loop;
    const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
    const Vec3 axis = i == 0 ? Vec3::UnitY() : Vec3::UnitX(), top(0, 0, i == 0 ? 0 : -0.08);
    geometry::Chain ring = geometry::straight_chain(ribbon, {top, Quat::Identity()});
    Mat3 frame;  // d1 down, d3 square to the axis
    frame << -Vec3::UnitZ(), axis, (-Vec3::UnitZ()).cross(axis);
    ring.base.frame = Quat(frame);
    for (double& kappa : ring.kappa) kappa = 2 * pi / 0.3;
    constraint::Surroundings surroundings = touching(1e-3);
    surroundings.gravity = Vec3(0, 0, -9.81);
    if (i == 0) {
      constraint::Support clamp;
      clamp.segment = 0;
      clamp.motion.keys = {{0, {top, ring.base.frame}, 0}};
      surroundings.supports.push_back(clamp);
    }
    m.paths.push_back(solver::make_path(ribbon, surroundings, {}));
    shapes.push_back(geometry::state_of(ribbon, ring, 0));
  }
  const std::vector<Vec3> spins(2, Vec3::Zero());
  m.state = implicit::start(m.paths, m.options, shapes, spins, m.work);
  double nearest = 1;
  for (int i = 1; i <= count; ++i) {
    ASSERT_TRUE(move_to(2e-3 * i, m));
    ASSERT_EQ(crossings_of(m), 0) << "at step " << i;
    const geometry::State a = implicit::shape_of(m.paths[0], m.state.strips[0]);
    const geometry::State b = implicit::shape_of(m.paths[1], m.state.strips[1]);
    ASSERT_NEAR(std::abs(linking(a.r, b.r)), 1, 1e-6) << "at step " << i;
    ASSERT_LT((a.r.back() - a.r.front()).norm(), 1e-10);
    nearest = std::min(nearest, smallest_distance(m.work.self, m.work.newton.self));
  }
  EXPECT_GT(nearest, 0);
  if (is_slow_build()) return;
  EXPECT_LT(nearest, 1e-3);  // they have touched
  const geometry::State b = implicit::shape_of(m.paths[1], m.state.strips[1]);
  EXPECT_GT(b.r[15].z(), -0.25);  // and the second one hangs
}

}  // namespace
}  // namespace wunderlich::testing
