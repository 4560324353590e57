// Loads without a potential: their derivatives, the helices that they make, and where no minimum of an energy is.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/rods.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

/// Work of a load in a small increment from a state, counted from what its section and its node do in space; the
/// increment taken on top of another from the state that frames are carried from.
double work_of(const Rod& sample, const rod::Follower& load, const rod::State& base, const std::vector<double>& there,
               const std::vector<double>& further) {
  const double h = 1e-6;
  std::vector<double> ahead = there, behind = there;
  for (std::size_t c = 0; c < there.size(); ++c) {
    ahead[c] += h * further[c];
    behind[c] -= h * further[c];
  }
  rod::State at = base, after = base, before = base;
  rod::move(sample, base, there, 1, at);
  rod::move(sample, base, ahead, 1, after);
  rod::move(sample, base, behind, 1, before);
  const auto frame = [&](const rod::State& state) {
    const rod::Section s = rod::section(state, load.edge);
    Mat3 m;
    m << s.m1, s.m2, s.m3;
    return m;
  };
  const Quat turn(Mat3(frame(after) * frame(before).transpose()));
  const Vec3 force = load.turns ? Vec3(frame(at) * load.force) : load.force;
  const Vec3 torque = load.turns ? Vec3(frame(at) * load.torque) : load.torque;
  return (force.dot(after.x[load.node] - before.x[load.node]) + torque.dot(math::log_map(turn))) / (2 * h);
}

std::vector<double> times(double factor, std::vector<double> v) {
  for (double& x : v) x *= factor;
  return v;
}

// @eq Bergou2010
TEST(RodFollowers, ForceAndDerivativeAreThoseOfTheirWork) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  const Rod sample = sample_rods().front();
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (const bool turns : {false, true}) {
    for (const std::size_t node : {std::size_t{3}, std::size_t{4}}) {
      const rod::Follower load{node, 3, turns, turns ? any() : Vec3::Zero(), any()};
      const rod::State base = random_state(sample, random);
      const std::vector<double> d = random_increment(sample, random), e = random_increment(sample, random);
      const rod::FollowerTerms t = rod::follower_terms(base, load);
      const Eigen::Map<const rod::Vec7> along(d.data() + 12), further(e.data() + 12);
      const double work = work_of(sample, load, base, times(0, d), e);
      EXPECT_NEAR(t.force.dot(further), work, 1e-7 * std::abs(work) + 1e-8);
      const double h = 1e-3, slope = (work_of(sample, load, base, times(h, d), e) -
                                      work_of(sample, load, base, times(-h, d), e)) /
                                     (2 * h);
      EXPECT_GT(std::abs(slope), 1e-2);
      EXPECT_NEAR(further.dot(t.derivative * along), slope, 1e-4 * std::abs(slope) + 1e-4);
    }
  }
}

void expect_order(const std::vector<double>& errors, double order) {
  for (std::size_t k = 1; k < errors.size(); ++k)
    EXPECT_GE(std::log2(errors[k - 1] / errors[k]), order) << errors[k - 1] << " " << errors[k];
}

struct Helix {
  PathEnd path;
  double curvature = 0, torsion = 0;  ///< errors, largest of all inner nodes
};

/// A rod clamped at its start, a wrench on its end that is constant in the section: curvature and twist are uniform
/// where force and torque are those of a helix.
Helix helix(int n, const rod::Stiffness& s, double kappa, double tau) {
  geometry::RibbonSpec spec;
  spec.segments = n;
  const Rod sample = rod::make_rod(spec, s);
  const Vec3 force = (s.twist - s.soft) * tau * Vec3(0, kappa, tau), torque(0, s.soft * kappa, s.twist * tau);
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0)};
  constraint::Load load{n, constraint::LoadFrame::material, {}};
  for (int k = 0; k <= 20; ++k) {
    const double part = k / 20.0;
    load.keys.push_back({part, part * part * force, part * torque});
  }
  surroundings.loads = {load};
  const PathEnd end = along_path(sample, surroundings, rod::straight_state(sample), 20);
  Helix out{end, 0, 0};
  for (std::size_t i = 1; i < sample.edges(); ++i) {
    const rod::Strain strain = rod::strain(sample, end.state, i);
    out.curvature = std::max(out.curvature, std::abs(strain.soft - kappa));
    out.torsion = std::max(out.torsion, std::abs(strain.twist - tau));
  }
  return out;
}

// A torque that turns with the section has no potential. Where bending and twist are equally stiff it alone makes a
// helix, kappa = M2/B and tau = M3/C; its end turns by 8 rad. Iterations stay few only with stresses as unknowns and
// steps judged by the one that follows.   @eq Magisano2017, Deuflhard2011
TEST(RodFollowers, TorqueFixedInTheSectionMakesTheHelixToSecondOrder) {
  std::vector<double> curvature, torsion;
  for (const int n : {40, 80, 160}) {
    const Helix end = helix(n, rod::Stiffness{1e5, 1.5, 1e3, 1.5}, 7, 4);
    ASSERT_TRUE(end.path.done) << rod::outcome_name(end.path.last.outcome);
    EXPECT_LE(end.path.iterations, 7 * 20);
    curvature.push_back(end.curvature);
    torsion.push_back(end.torsion);
  }
  expect_order(curvature, 1.8);
  expect_order(torsion, 1.8);
  EXPECT_LE(curvature.back(), 0.01 * 7);
  EXPECT_LE(torsion.back(), 0.025 * 4);
}

// A force along the helix's axis holds it where they are not. It is at the end of the last edge and turns with the
// edge's middle: first order.
TEST(RodFollowers, WrenchFixedInTheSectionMakesTheHelix) {
  std::vector<double> curvature, torsion;
  for (const int n : {20, 40, 80}) {
    const Helix end = helix(n, rod::Stiffness{1e5, 1.5, 1e3, 2.5}, 4, 3);
    ASSERT_TRUE(end.path.done) << rod::outcome_name(end.path.last.outcome);
    EXPECT_LE(end.path.iterations, 7 * 20);
    curvature.push_back(end.curvature);
    torsion.push_back(end.torsion);
  }
  expect_order(curvature, 0.9);
  expect_order(torsion, 0.9);
}

/// Energy of a strip of length 1 that a wrench on its free end, constant in the section, bends and twists: Kirchhoff's
/// equations M' + u x M + d3 x F = 0, F' + u x F = 0 in the section, from the free end by a fourth-order method. The
/// pieces of length `left_out` at the ends are left out.
double kirchhoff_energy(const rod::Stiffness& s, Vec3 force, Vec3 torque, double left_out) {
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  const auto rate = [&](const Vec7& y) {
    const Vec3 f = y.head<3>(), m = y.segment<3>(3), u(m.x() / s.hard, m.y() / s.soft, m.z() / s.twist);
    Vec7 out;
    out << -u.cross(f), -u.cross(m) - Vec3::UnitZ().cross(f), -0.5 * m.dot(u);
    return out;
  };
  Vec7 y;
  y << force, torque, 0;
  const int steps = 4000;
  const double h = -1.0 / steps;
  double first = 0, last = 0;
  for (int i = 0; i < steps; ++i) {
    if (i == std::lround(left_out * steps)) first = y[6];
    if (i == std::lround((1 - left_out) * steps)) last = y[6];
    const Vec7 a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return last - first;
}

// The scene `helix`, whose wrench makes a helix of a ribbon: a rod bends otherwise under it, and further. First order,
// as above.
TEST(RodFollowers, WrenchOnTheFreeEndBendsAsKirchhoffSays) {
  const Vec3 force(0, 2.9296875, 2.197265625), torque(0, 0.2734375, 0.9375);
  std::vector<double> errors;
  for (const int n : {100, 200, 400}) {
    geometry::RibbonSpec spec;
    spec.segments = n;
    rod::Stiffness stiffness = rod::physical(spec, 0.3, 1e-3);
    stiffness.stretch *= 100;
    const Rod sample = rod::make_rod(spec, stiffness);
    constraint::Surroundings surroundings;
    surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()}, Vec3::Zero(), 0)};
    surroundings.loads = {{n,
                           constraint::LoadFrame::material,
                           {{0, Vec3::Zero(), Vec3::Zero()},
                            {0.25, Vec3::Zero(), Vec3(0, 0.4, 0)},
                            {0.5, Vec3(0, 0.45, 0.113), Vec3(0, 0.4, 0.2125)},
                            {0.75, Vec3(0, 1.25, 0.625), Vec3(0, 0.375, 0.5)},
                            {1, force, torque}}}};
    const PathEnd end = along_path(sample, surroundings, rod::straight_state(sample), 40);
    ASSERT_TRUE(end.done) << rod::outcome_name(end.last.outcome);
    const double expected = kirchhoff_energy(sample.stiffness, force, torque, 0.5 / n);
    errors.push_back(std::abs(end.energy / expected - 1));
  }
  expect_order(errors, 0.8);
  EXPECT_LE(errors.back(), 0.005);
}

}  // namespace
}  // namespace wunderlich::testing
