// Friction of a strip on itself: derivatives, what it leaves alone, and Coulomb's threshold between two strips.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/coil.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_objective.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using geometry::Chain;

/// A coil that has slid on itself by less than the way of full friction at some places, and by more at others.
struct Sliding {
  Coil coil;
  Chain now;
  solver::SelfContact& self = coil.problem.self;
  Sliding() {
    geometry::Kinematics k;
    geometry::forward_kinematics(coil.ribbon, coil.chain, k);
    solver::SelfSearch search;
    solver::SelfContacts before;
    find_pairs(alone(coil.ribbon, coil.chain, k), self, search, before);
    self.friction = 0.4;
    set_friction(before, 1, self);
    self.slip = 0.03;
    EXPECT_GT(self.rubs.size(), 20u);
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 0.02);
    VectorXd way = VectorXd::NullaryExpr(2 * coil.ribbon.node_count(), [&] { return normal(random); });
    for (int i : {0, coil.ribbon.segments}) way[2 * i] = 0;  // free ends do not fold
    now = moved(coil.chain, way);
  }
};

struct Linear {
  double value;
  VectorXd gradient, step;
  std::vector<math::SurfacePoint> rubbing;
};

Linear linear(const Sliding& sliding, const Chain& chain, bool settled) {
  const Coil& coil = sliding.coil;
  geometry::Kinematics k, start;  // loads are counted from the coil as it was
  geometry::forward_kinematics(coil.ribbon, chain, k);
  geometry::forward_kinematics(coil.ribbon, coil.chain, start);
  solver::Touching touching;
  solver::SelfSearch search;
  const auto strips = alone(coil.ribbon, chain, k);
  find_pairs(strips, sliding.self, search, touching.self);
  math::ChainSystem system;
  linearise(coil.ribbon, coil.problem, chain, k, {}, touching, system);
  const auto others = static_cast<std::ptrdiff_t>(system.points.size());
  math::ChainSystem* const systems[] = {&system};
  std::vector<math::ChainCoupling> between;
  add_self_friction(strips, sliding.self, touching.self, settled, systems, between);
  math::ChainWorkspace work;
  math::ChainStep step;
  EXPECT_TRUE(chain_step(system, work, step));
  Linear out{objective(coil.ribbon, coil.problem, chain, k, start).total() + self_energy(sliding.self, touching.self) +
                 friction_value(sliding.self, touching.self),
             VectorXd(2 * coil.ribbon.node_count()),
             VectorXd(2 * coil.ribbon.node_count()),
             {system.points.begin() + others, system.points.end()}};
  for (math::SurfacePoint& point : out.rubbing) point.arm += k.r[static_cast<std::size_t>(point.node)];
  for (std::size_t i = 0; i < work.gradient.size(); ++i) {
    out.gradient.segment<2>(2 * static_cast<Index>(i)) = work.gradient[i];
    out.step.segment<2>(2 * static_cast<Index>(i)) = step.u[i];
  }
  return out;
}

TEST(SelfFriction, GradientIsTheSlopeAndHessianItsDerivative) {
  const Sliding sliding;
  const Linear here = linear(sliding, sliding.now, true);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  VectorXd d = VectorXd::NullaryExpr(here.gradient.size(), [&] { return normal(random); });
  for (int i : {0, sliding.coil.ribbon.segments}) d[2 * i] = 0;
  constexpr double kStep = 1e-6;
  const auto at = [&](double h, const VectorXd& way) { return linear(sliding, moved(sliding.now, h * way), true); };
  const double slope = (at(kStep, d).value - at(-kStep, d).value) / (2 * kStep);
  EXPECT_GT(std::abs(slope), 1);
  EXPECT_NEAR(here.gradient.dot(d) / slope, 1, 1e-6);
  // Along Newton's step the gradient goes to zero, to first order.
  const VectorXd way = here.step / here.step.norm();
  const VectorXd bend = (at(kStep, way).gradient - at(-kStep, way).gradient) / (2 * kStep);
  EXPECT_GT(bend.norm(), 1);
  EXPECT_LT((bend * here.step.norm() + here.gradient).norm(), 1e-5 * here.gradient.norm());
}

/// Without it the test above would say nothing about friction.
TEST(SelfFriction, IsThere) {
  Sliding sliding;
  const Linear with = linear(sliding, sliding.now, true);
  sliding.self.rubs.clear();
  const Linear without = linear(sliding, sliding.now, true);
  EXPECT_GT((with.gradient - without.gradient).norm(), 1e-3 * with.gradient.norm());
  EXPECT_GT((with.step - without.step).norm(), 1e-3 * with.step.norm());
}

/// What one part does to the other is done to it. The forces act half a gap off each other's middle: their torques add
/// up to no more than force times gap and way.
TEST(SelfFriction, ActionIsReaction) {
  const Sliding sliding;
  const Linear here = linear(sliding, sliding.now, true);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  for (const math::SurfacePoint& point : here.rubbing) {
    force += point.gradient;
    torque += point.arm.cross(point.gradient);
    size += point.gradient.norm();
  }
  EXPECT_GT(size, 0.1);
  EXPECT_LT(force.norm(), 1e-13 * size);
  double most = 0;
  for (const solver::SelfRub& rub : sliding.self.rubs) most += rub.force * (rub.from.norm() + 0.3);
  EXPECT_LT(torque.norm(), most);
}

/// The way that counts is the material's: rulings that turn alone rub nothing.
TEST(SelfFriction, RulingsThatTurnMoveNoMaterial) {
  Sliding sliding;
  sliding.now = sliding.coil.chain;
  for (double& eta : sliding.now.eta) eta += 0.03;
  geometry::Kinematics k, turned;
  geometry::forward_kinematics(sliding.coil.ribbon, sliding.coil.chain, k);
  turned = k;
  solver::SelfContacts at;
  find_material(alone(sliding.coil.ribbon, sliding.now, turned), sliding.self, at.material);
  EXPECT_LT(friction_value(sliding.self, at), 1e-25);
}

}  // namespace
}  // namespace wunderlich::testing
