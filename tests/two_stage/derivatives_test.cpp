// Derivatives of stage opt against finite differences, on every kind of ribbon, off the constraints.
#include <gtest/gtest.h>

#include <random>

#include "support/random_state.hpp"
#include "support/taylor.hpp"
#include "two_stage/cases.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/parallel_coupling.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/kkt.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::testing {
namespace {

using solver::two_stage::Workspace;

/// A ribbon in a random state with inertia and torques, as stage opt sees it. A loop's last eta is its first.
struct Setting {
  geometry::Ribbon ribbon;
  two_stage::Options options;
  two_stage::Drive drive;
  geometry::State shape;
  Workspace work;
  std::vector<double> direction, multipliers;
};

Setting setting(const geometry::Ribbon& ribbon, bool central, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Setting s;
  s.ribbon = ribbon;
  s.options.opt.central_rate = central;
  s.shape = random_state(ribbon, random);
  if (ribbon.is_loop()) {
    for (double& eta : s.shape.eta) eta *= 0.3;  // so that the closing segment keeps |x| < 1
    s.shape.eta.back() = ribbon.seam_sign() * s.shape.eta.front();
  }
  prepare(s.options, ribbon, s.drive, s.shape, s.work);
  s.options.opt.proximal = 0.3;
  for (double& eta : s.work.before.eta) eta += 0.1 * normal(random);
  for (std::size_t i = 0; i < s.shape.q.size(); ++i) {
    s.work.inertia[i] = 0.3 + 0.1 * static_cast<double>(i);
    s.work.carried[i] = s.shape.q[i] * math::exp_map(0.2 * Vec3(normal(random), normal(random), normal(random)));
    s.work.torque[i] = 0.1 * Vec3(normal(random), normal(random), normal(random));
  }
  s.direction.resize(static_cast<std::size_t>(4 * two_stage::block_count(ribbon)));
  for (double& d : s.direction) d = normal(random);
  two_stage::clear_held(ribbon, s.work, s.direction);
  s.multipliers.resize(s.direction.size() / 2);
  for (double& m : s.multipliers) m = 0.1 * normal(random);
  return s;
}

geometry::State moved_by(double h, Setting& s) {
  geometry::State out = s.shape;
  two_stage::move_unknowns(s.ribbon, s.direction, h, s.work, out);
  two_stage::refresh_strains(s.ribbon, s.options.model, out, true, s.work);
  return out;
}

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

TEST(TwoStageObjective, GradientIsThatOfTheValue) {
  std::mt19937 random(3);
  for (const NamedRibbon& named : sample_ribbons()) {
    for (const bool central : {false, true}) {
      SCOPED_TRACE(named.name + (central ? ", central difference" : ""));
      Setting s = setting(named.ribbon, central, random);
      moved_by(0, s);
      two_stage::objective_gradient(s.ribbon, s.options, s.shape, s.work);
      double along = 0;
      for (std::size_t i = 0; i < s.direction.size(); ++i) along += s.work.gradient[i] * s.direction[i];
      const auto value = [&](double h) {
        const geometry::State at = moved_by(h, s);
        return one(two_stage::objective_value(s.ribbon, s.options, at, s.work));
      };
      expect_derivative(value, one(along));
    }
  }
}

TEST(TwoStageObjective, IsTheEnergyOfTheOtherLayers) {
  std::mt19937 random(5);
  for (const NamedRibbon& named : sample_ribbons()) {
    SCOPED_TRACE(named.name);
    Setting s = setting(named.ribbon, false, random);
    std::fill(s.work.inertia.begin(), s.work.inertia.end(), 0.0);
    std::fill(s.work.torque.begin(), s.work.torque.end(), Vec3::Zero());
    s.work.before = s.shape;
    const geometry::State at = moved_by(0, s);
    const double expected = energy::elastic_value(s.ribbon, s.options.model, at) +
                            energy::barrier_value(s.ribbon, s.options.opt.barrier, at) +
                            energy::parallel_value(s.ribbon, s.work.parallel_weight, at);
    EXPECT_NEAR(two_stage::objective_value(s.ribbon, s.options, at, s.work), expected, 1e-12 * expected);
  }
}

/// Gradient of the Lagrangian and the constraints along the move by h, in the chart of the state at h = 0.
Eigen::VectorXd lagrangian_slope(double h, Setting& s) {
  const geometry::State at = moved_by(h, s);
  two_stage::objective_gradient(s.ribbon, s.options, at, s.work);
  std::vector<double> slope = s.work.gradient;
  const std::vector<double> multipliers = s.multipliers;
  for (std::size_t k = 0; k < s.work.hinges.size(); ++k) {
    const geometry::Hinge& hinge = s.work.hinges[k];
    const auto b = static_cast<std::size_t>(2 * two_stage::hinge_block(s.ribbon, hinge));
    const double eta = at.eta[static_cast<std::size_t>(hinge.node)], kappa = s.work.strain[k][1];
    const double l0 = hinge.length * multipliers[b], l1 = hinge.length * multipliers[b + 1];
    const Vec3 weight(l0, l1 * eta, -l1);
    for (int d = 0; d < 3; ++d) {
      if (hinge.before >= 0)
        slope[static_cast<std::size_t>(4 * hinge.before + 1 + d)] += s.work.jet[k].before.col(d).dot(weight);
      if (hinge.after >= 0)
        slope[static_cast<std::size_t>(4 * hinge.after + 1 + d)] += s.work.jet[k].after.col(d).dot(weight);
    }
    const auto& view = s.work.views[static_cast<std::size_t>(hinge.node)];
    slope[static_cast<std::size_t>(4 * view.eta)] += view.eta_sign * l1 * kappa;
  }
  two_stage::clear_held(s.ribbon, s.work, slope);
  two_stage::constraint_residual(s.ribbon, at, s.work);
  Eigen::VectorXd out(static_cast<Eigen::Index>(slope.size() + s.work.residual.size()));
  for (std::size_t b = 0; 4 * b < slope.size(); ++b) {
    const Vec3 move(h * s.direction[4 * b + 1], h * s.direction[4 * b + 2], h * s.direction[4 * b + 3]);
    const Vec3 turn =
        math::right_jacobian(move).transpose() * Vec3(slope[4 * b + 1], slope[4 * b + 2], slope[4 * b + 3]);
    const auto row = static_cast<Eigen::Index>(6 * b);
    out[row] = slope[4 * b];
    out.segment<3>(row + 1) = turn;
    out[row + 4] = s.work.residual[2 * b];
    out[row + 5] = s.work.residual[2 * b + 1];
  }
  return out;
}

TEST(TwoStageKkt, IsTheDerivativeOfTheLagrangiansGradient) {
  std::mt19937 random(11);
  for (const NamedRibbon& named : sample_ribbons()) {
    SCOPED_TRACE(named.name);
    Setting s = setting(named.ribbon, false, random);
    // The torque's work is taken to first order only.
    std::fill(s.work.torque.begin(), s.work.torque.end(), Vec3::Zero());
    moved_by(0, s);
    two_stage::objective_gradient(s.ribbon, s.options, s.shape, s.work);
    two_stage::assemble_kkt(s.ribbon, s.options, s.shape, s.multipliers, two_stage::Curvature::exact, 0, s.work);
    const int blocks = two_stage::block_count(s.ribbon);
    Eigen::VectorXd product = Eigen::VectorXd::Zero(6 * blocks);
    for (int b = 0; b < blocks; ++b) {
      for (int k = 0; k < 6; ++k) {
        const int row = two_stage::block_row(s.ribbon, b) + k;
        for (int other = 0; other < blocks; ++other) {
          for (int m = 0; m < 4; ++m) {
            const int column = two_stage::block_row(s.ribbon, other) + m;
            if (std::abs(row - column) > s.work.system.bandwidth) continue;
            product[6 * b + k] += s.work.system.at(row, column) * s.direction[static_cast<std::size_t>(4 * other + m)];
          }
        }
      }
    }
    expect_derivative([&](double h) { return lagrangian_slope(h, s); }, product);
  }
}

TEST(TorsionalInertia, HasTheDerivativesOfItsValue) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  const Quat carried = math::exp_map(any()), frame = carried * math::exp_map(0.7 * any());
  const Vec3 along = any();
  const energy::TurnTerms terms = energy::torsional_inertia(2.5, carried, frame);
  const auto at = [&](double h) { return energy::torsional_inertia(2.5, carried, frame * math::exp_map(h * along)); };
  const auto value = [&](double h) {
    return one(2.5 * std::pow(energy::turn_between(carried, frame * math::exp_map(h * along)), 2));
  };
  expect_derivative(value, one(terms.gradient.dot(along)));
  const auto slope = [&](double h) {
    return Eigen::VectorXd(math::right_jacobian(h * along).transpose() * at(h).gradient);
  };
  expect_derivative(slope, terms.hessian * along);
}

TEST(TorsionalInertia, SeesOnlyTheTurnAboutTheTangent) {
  const Quat frame = math::exp_map({0.3, -0.8, 0.5});
  const Quat turned = frame * math::exp_map({0, 0, 0.4});
  EXPECT_NEAR(energy::turn_between(frame, turned), 0.4, 1e-14);
  const Quat tilted = frame * math::exp_map({0.4, -0.2, 0});
  EXPECT_NEAR(energy::turn_between(frame, tilted), 0, 1e-14);
}

}  // namespace
}  // namespace wunderlich::testing
