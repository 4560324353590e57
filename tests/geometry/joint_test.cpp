// Folds and forward kinematics: joint coordinates against finite differences and against the constraints.
#include "wunderlich/geometry/joint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/random_state.hpp"
#include "support/taylor.hpp"
#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using geometry::Chain;
using geometry::Ribbon;
using geometry::RibbonSpec;

constexpr double kPi = 3.14159265358979323846;

struct Joint {
  double h, kappa, eta;
  Quat rotation() const { return fold_rotation(geometry::make_fold(h, kappa, eta), eta); }
  /// Rotation vector from the fold to the one at (kappa + dkappa, eta + deta), in the parent's axes.
  Vec3 turn(double dkappa, double deta) const {
    return math::log_map(Joint{h, kappa + dkappa, eta + deta}.rotation() * rotation().conjugate());
  }
};

struct Derivatives {
  Vec3 kappa, eta, kappa_eta, eta_eta;
};

Derivatives derivatives(const Joint& joint) {
  const auto [h, kappa, eta] = joint;
  const auto d = fold_derivatives(geometry::make_fold(h, kappa, eta), h, kappa, eta);
  const auto vector = [](const geometry::InFrame<double>& v) { return Vec3(v.x, v.y, v.z); };
  return {vector(d.kappa), vector(d.eta), vector(d.kappa_eta), vector(d.eta_eta)};
}

/// Random ones, flat ones (kappa = 0, eta = 0) and folds by more than a right angle.
std::vector<Joint> sample_joints() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Joint> out{{0.3, 0, 0}, {0.3, 0, 1.2}, {0.2, 2.5, 0}, {0.5, 4.2, 0.3}, {0.5, -4.5, -0.8}};
  for (int k = 0; k < 10; ++k)
    out.push_back({0.1 + 0.4 * std::abs(normal(random)), 3 * normal(random), normal(random)});
  return out;
}

TEST(Fold, IsATurnAboutTheRuling) {
  // @eq Shen2015:14 @eq Shen2015:15
  double largest = 0;
  for (const Joint& joint : sample_joints()) {
    const Vec3 vector = joint.h * joint.kappa * Vec3(0, 1, joint.eta);
    largest = std::max(largest, vector.norm());
    const Quat q = joint.rotation(), expected = math::exp_map(vector);
    EXPECT_LE((q.coeffs() - expected.coeffs()).norm(), 1e-15);
    const Vec3 ruling = Vec3(0, 1, joint.eta);
    EXPECT_LE((q * ruling - ruling).norm(), 1e-15 * ruling.norm() + 1e-15);
  }
  EXPECT_GT(largest, kPi / 2);
}

TEST(Fold, FirstDerivatives) {
  for (const Joint& joint : sample_joints()) {
    SCOPED_TRACE(std::to_string(joint.h) + " " + std::to_string(joint.kappa) + " " + std::to_string(joint.eta));
    const Derivatives d = derivatives(joint);
    // Along kappa alone the turn is linear: a rotation about the ruling.
    EXPECT_LE((joint.turn(0.1, 0) - 0.1 * d.kappa).norm(), 1e-15);
    if (joint.kappa == 0) {
      EXPECT_EQ(d.eta.norm(), 0);  // a flat joint has a ruling, but no fold to show it
      EXPECT_LE(joint.turn(0, 0.1).norm(), 1e-15);
    } else {
      expect_derivative([&](double h) -> VectorXd { return joint.turn(0, h); }, d.eta);
    }
    expect_derivative([&](double h) -> VectorXd { return joint.turn(-0.7 * h, h); }, -0.7 * d.kappa + d.eta);
  }
}

/// Small angles, large ones and both in one vector of four.
TEST(Fold, OfFourIsThatOfEach) {
  const std::vector<Joint> joints = sample_joints();
  for (std::size_t i = 0; i + 4 <= joints.size(); ++i) {
    const Joint* j = joints.data() + i;
    const math::Four h{j[0].h, j[1].h, j[2].h, j[3].h}, kappa{j[0].kappa, j[1].kappa, j[2].kappa, j[3].kappa};
    const math::Four eta{j[0].eta, j[1].eta, j[2].eta, j[3].eta};
    const auto d = fold_derivatives(geometry::make_fold(h, kappa, eta), h, kappa, eta);
    for (int lane = 0; lane < 4; ++lane) {
      const Derivatives one = derivatives(j[lane]);
      const auto error = [&](const geometry::InFrame<math::Four>& v, const Vec3& expected) {
        return (Vec3(v.x[lane], v.y[lane], v.z[lane]) - expected).norm() / (1 + expected.norm());
      };
      EXPECT_LE(error(d.kappa, one.kappa), 1e-15);
      EXPECT_LE(error(d.eta, one.eta), 1e-15);
      EXPECT_LE(error(d.kappa_eta, one.kappa_eta), 1e-15);
      EXPECT_LE(error(d.eta_eta, one.eta_eta), 1e-15);
    }
  }
}

TEST(Fold, SecondDerivatives) {
  for (const Joint& joint : sample_joints()) {
    SCOPED_TRACE(std::to_string(joint.h) + " " + std::to_string(joint.kappa) + " " + std::to_string(joint.eta));
    const Derivatives d = derivatives(joint);
    for (const Vec2& way : {Vec2(0, 1), Vec2(0.8, 0.6), Vec2(-0.6, 0.8)}) {
      const Vec3 second = 2 * way[0] * way[1] * d.kappa_eta + way[1] * way[1] * d.eta_eta;
      const auto error = [&](double h) {
        const Vec3 difference = (joint.turn(h * way[0], h * way[1]) + joint.turn(-h * way[0], -h * way[1])) / (h * h);
        return (difference - second).norm();
      };
      if (joint.kappa != 0 || way[0] != 0) {
        EXPECT_GT(second.norm(), 1e-3);
      }
      EXPECT_LE(error(1e-3), 1e-4 * (1 + second.norm()));
      if (error(8e-3) > 1e-9) {
        EXPECT_GE(std::log2(error(3.2e-2) / error(1.6e-2)), 1.8);
        EXPECT_GE(std::log2(error(1.6e-2) / error(8e-3)), 1.8);
      }
    }
  }
}

/// Random joint coordinates wherever the ribbon has any.
Chain random_chain(const Ribbon& ribbon, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vec3 turn(normal(random), normal(random), normal(random));
  Chain chain = geometry::straight_chain(ribbon, {Vec3(1, -2, 0.5), math::exp_map(turn)});
  for (int i = 0; i <= ribbon.segments; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (kappa_is_free(ribbon, i)) chain.kappa[k] = 0.9 * unit(random) / geometry::fold_length(ribbon, k);
    if (eta_is_free(ribbon, i)) chain.eta[k] = unit(random);
  }
  return chain;
}

/// Open strips of every kind: free, clamped, not uniform, with free rulings.
std::vector<NamedRibbon> open_ribbons() {
  std::vector<NamedRibbon> out;
  for (const NamedRibbon& sample : sample_ribbons()) {
    if (!sample.ribbon.is_loop()) out.push_back(sample);
  }
  RibbonSpec spec;
  spec.segments = 40;
  spec.free_rulings = true;
  out.push_back({"free rulings", make_ribbon(spec)});
  spec.clamped = {false, true};
  spec.segments = 400;
  out.push_back({"long, clamped at the end", make_ribbon(spec)});
  return out;
}

// @eq Shen2015:12 @eq Shen2015:14 @eq Shen2015:15 @eq Shen2015:16
TEST(ForwardKinematics, KeepsEveryConstraint) {
  std::mt19937 random(2);
  for (const auto& [name, ribbon] : open_ribbons()) {
    SCOPED_TRACE(name);
    const geometry::State state = state_of(ribbon, random_chain(ribbon, random), 0);
    const ConstraintErrors e = constraint::errors(ribbon, state);
    EXPECT_LE(e.max_length_error, 1e-13);
    EXPECT_LE(e.max_parallel_error, 1e-13);
    EXPECT_LE(e.max_binormal, 1e-13);
    EXPECT_LE(e.max_torsion_mismatch, 1e-13);
    for (const Quat& q : state.q) EXPECT_NEAR(q.norm(), 1, 1e-14);
  }
}

void expect_same_chain(const Chain& a, const Chain& b) {
  EXPECT_LE((a.base.position - b.base.position).norm(), 1e-15);
  EXPECT_LE(a.base.frame.angularDistance(b.base.frame), 1e-7);  // an arc cosine near 1
  for (std::size_t i = 0; i < a.kappa.size(); ++i) {
    EXPECT_NEAR(a.kappa[i], b.kappa[i], 1e-12 * (1 + std::abs(a.kappa[i]))) << i;
    EXPECT_EQ(a.eta[i], b.eta[i]) << i;
  }
}

TEST(JointCoordinates, ComeBackFromAState) {
  std::mt19937 random(3);
  for (const auto& [name, ribbon] : open_ribbons()) {
    SCOPED_TRACE(name);
    const Chain chain = random_chain(ribbon, random);
    expect_same_chain(chain, chain_of(ribbon, state_of(ribbon, chain, 0)));
  }
}

TEST(JointCoordinates, ComeBackFromALoop) {
  // A planar loop of random curvature and a whole turn; rulings that slant where it is not bent.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.5, 1.5);
  for (int half_twists : {0, 2}) {
    RibbonSpec spec;
    spec.segments = 24;
    spec.closure = geometry::Closure::loop;
    spec.half_twists = half_twists;
    for (int s = 0; s < spec.segments; ++s) spec.spacing.push_back(unit(random));
    const Ribbon ribbon = make_ribbon(spec);
    Chain chain = geometry::straight_chain(ribbon, {Vec3(1, 2, 3), math::exp_map(Vec3(0.3, 0.4, -0.2))});
    double total = 0;
    for (std::size_t i = 1; i < chain.kappa.size(); ++i) {
      chain.kappa[i] = i % 5 == 3 ? 0 : unit(random);
      chain.eta[i] = i % 5 == 3 ? unit(random) : 0;
      total += chain.kappa[i] * ribbon.hinge_length[i];
    }
    for (double& kappa : chain.kappa) kappa *= 2 * kPi / total;
    chain.kappa.front() = chain.kappa.back();
    const geometry::State state = state_of(ribbon, chain, 0);
    const ConstraintErrors e = constraint::errors(ribbon, state);
    EXPECT_LE(std::max({e.max_length_error, e.max_parallel_error, e.max_binormal, e.max_torsion_mismatch}), 1e-13);
    expect_same_chain(chain, chain_of(ribbon, state));
  }
}

}  // namespace
}  // namespace wunderlich::testing
