// Derivatives of a rod's energies at random states, and what must not change them.
#include <gtest/gtest.h>

#include <cmath>

#include "baseline/rods.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

/// Unknowns of a rod that nothing holds.
rod::Unknowns all_free(const Rod& sample, const rod::State& state) {
  rod::Unknowns unknowns;
  rod::hold(sample, {}, state, 0, false, unknowns);
  return unknowns;
}

rod::Objective no_loads(const Rod& sample) {
  rod::Objective objective;
  objective.force.assign(sample.nodes(), Vec3::Zero());
  return objective;
}

struct Along {
  double first = 0, second = 0;
};

/// Derivatives along an increment by the assembled gradient and Hessian.
Along along(const Rod& sample, const rod::Objective& objective, const rod::State& state, const std::vector<double>& d) {
  const rod::Unknowns u = all_free(sample, state);
  rod::System system;
  rod::assemble(sample, objective, state, u, system);
  std::vector<double> step(static_cast<std::size_t>(u.count));
  for (std::size_t c = 0; c < d.size(); ++c) {
    if (u.number[c] >= 0) step[static_cast<std::size_t>(u.number[c])] = d[c];
  }
  Along out;
  for (int i = 0; i < u.count; ++i) {
    const double s = step[static_cast<std::size_t>(i)];
    out.first += s * system.gradient[static_cast<std::size_t>(i)];
    for (int k = std::max(0, i - u.bandwidth); k <= std::min(u.count - 1, i + u.bandwidth); ++k)
      out.second += s * step[static_cast<std::size_t>(k)] * system.hessian.at(i, k);
  }
  return out;
}

/// Expects that what is left of the value beyond the second order falls as the cube of the step.
void expect_second_derivatives(const Rod& sample, const rod::Objective& objective, const rod::State& state,
                               const std::vector<double>& d) {
  const Along slope = along(sample, objective, state, d);
  EXPECT_GT(std::abs(slope.first), 1e-3);
  EXPECT_GT(std::abs(slope.second), 1e-3);
  const double start = rod::value(sample, objective, state);
  std::vector<double> first, second;
  for (double h : {8e-3, 4e-3, 2e-3, 1e-3}) {
    rod::State moved = state;
    rod::move(sample, state, d, h, moved);
    const double left = rod::value(sample, objective, moved) - start - h * slope.first;
    first.push_back(std::abs(left));
    second.push_back(std::abs(left - 0.5 * h * h * slope.second));
  }
  EXPECT_GE(std::log2(first.front() / first.back()) / 3, 1.7);
  EXPECT_GE(std::log2(second.front() / second.back()) / 3, 2.7);
}

// @eq Bergou2008:1, Bergou2008:2, Bergou2010
TEST(RodDerivatives, GradientAndHessianAreThoseOfTheEnergy) {
  std::mt19937 random(1);
  for (const Rod& sample : sample_rods()) {
    const rod::Stiffness all = sample.stiffness;
    // One energy at a time, so that a wrong term of one cannot hide behind another.
    for (const rod::Stiffness& only : {rod::Stiffness{all.stretch, 0, 0, 0}, rod::Stiffness{0, all.soft, 0, 0},
                                       rod::Stiffness{0, 0, all.hard, 0}, rod::Stiffness{0, 0, 0, all.twist}, all}) {
      Rod one = sample;
      one.stiffness = only;
      for (int repeat = 0; repeat < 3; ++repeat) {
        SCOPED_TRACE(::testing::Message() << "half twists " << sample.half_twists << " loop " << sample.is_loop() << " "
                                          << only.stretch << " " << only.soft << " " << only.hard << " " << only.twist);
        const rod::State state = random_state(one, random);
        expect_second_derivatives(one, no_loads(one), state, random_increment(one, random));
      }
    }
  }
}

// @eq Li2020:4
TEST(RodDerivatives, BarrierOfSolids) {
  std::mt19937 random(2);
  Rod sample = sample_rods().front();
  sample.stiffness = {};
  constraint::Surroundings surroundings;
  const Quat askew = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(0.2, 1, 0.3));
  surroundings.obstacles = {{contact::Cylinder{0.3, 10}, {{{0, {Vec3(1.2, 0.2, -1.3), askew}, 0}}}, 0},
                            {contact::Sphere{0.4}, {{{0, {Vec3(2.5, -0.3, 1.3), askew}, 0}}}, 0}};
  surroundings.contact.distance = 0.9;
  rod::Objective objective = no_loads(sample);
  objective.solids = rod::solids_at(sample, surroundings, 0);
  objective.solids.stiffness = 10;
  for (int repeat = 0; repeat < 5; ++repeat) {
    rod::State state = rod::straight_state(sample);
    rod::State moved = state;
    rod::move(sample, state, random_increment(sample, random), 0.1, moved);
    ASSERT_TRUE(std::isfinite(rod::value(sample, objective, moved)));
    expect_second_derivatives(sample, objective, moved, random_increment(sample, random));
  }
}

TEST(RodInvariance, RigidMotionsChangeNoEnergy) {
  std::mt19937 random(3);
  for (const Rod& sample : sample_rods()) {
    const rod::State state = random_state(sample, random);
    rod::State turned = state;
    const Quat q = math::exp_map(Vec3(0.7, -1.9, 0.4));
    for (Vec3& x : turned.x) x = Vec3(1, 2, 3) + q * x;
    for (Vec3& a : turned.reference) a = q * a;
    const rod::Energy before = rod::elastic_energy(sample, state), after = rod::elastic_energy(sample, turned);
    EXPECT_NEAR(after.stretch, before.stretch, 1e-12 * before.sum());
    EXPECT_NEAR(after.soft, before.soft, 1e-12 * before.sum());
    EXPECT_NEAR(after.hard, before.hard, 1e-12 * before.sum());
    EXPECT_NEAR(after.twist, before.twist, 1e-12 * before.sum());
    // Nor does it pull: the gradient has no part along rigid motions.
    std::vector<double> shift(rod::coordinate_count(sample)), spin(shift.size());
    for (std::size_t i = 0; i < sample.nodes(); ++i) {
      const Vec3 v = Vec3(0.2, 0.5, -0.3).cross(state.x[i]);
      for (int c = 0; c < 3; ++c) {
        shift[4 * i + static_cast<std::size_t>(c)] = c + 1;
        spin[4 * i + static_cast<std::size_t>(c)] = v[c];
      }
    }
    for (std::size_t j = 0; j < sample.edges(); ++j)
      spin[4 * j + 3] = Vec3(0.2, 0.5, -0.3).dot(rod::section(state, j).m3);
    const double scale = before.sum();
    EXPECT_NEAR(along(sample, no_loads(sample), state, shift).first, 0, 1e-11 * scale);
    EXPECT_NEAR(along(sample, no_loads(sample), state, spin).first, 0, 1e-11 * scale);
  }
}

TEST(RodInvariance, ReferenceDirectionsAreAGauge) {
  std::mt19937 random(4);
  for (const Rod& sample : sample_rods()) {
    const rod::State state = random_state(sample, random);
    rod::State other = state;
    const double turn = 0.9;
    const std::size_t j = 3;
    other.reference[j] = Eigen::AngleAxisd(turn, rod::section(state, j).m3) * state.reference[j];
    other.theta[j] -= turn;
    other.reference_twist[j] += turn;
    other.reference_twist[j + 1] -= turn;
    EXPECT_NEAR(rod::elastic_energy(sample, other).sum(), rod::elastic_energy(sample, state).sum(),
                1e-12 * rod::elastic_energy(sample, state).sum());
    // What is counted is what the directions say, up to whole turns.
    for (std::size_t i = 1; i < sample.edges(); ++i) {
      EXPECT_NEAR(std::remainder(rod::turn_between(other, rod::joined(sample, i)) - other.reference_twist[i], 2 * kPi),
                  0, 1e-12);
    }
    const std::vector<double> d = random_increment(sample, random);
    const Along a = along(sample, no_loads(sample), state, d), b = along(sample, no_loads(sample), other, d);
    EXPECT_NEAR(a.first, b.first, 1e-10 * std::abs(a.first));
    EXPECT_NEAR(a.second, b.second, 1e-10 * std::abs(a.second));
  }
}

}  // namespace
}  // namespace wunderlich::testing
