// A strip that feels itself: derivatives, what counts as a neighbour, and loops that would pass through themselves.
#include "wunderlich/solver/self_contact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "solver/paths.hpp"
#include "wunderlich/geometry/topology.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using solver::ChainProblem;

/// Two turns and a half of a coil whose turns lean on each other.
struct Coil {
  Ribbon ribbon;
  Chain chain;
  ChainProblem problem;
  Coil() {
    geometry::RibbonSpec spec;
    spec.length = 4;
    spec.width = 0.3;
    spec.segments = 18;
    spec.free_rulings = true;
    ribbon = geometry::make_ribbon(spec);
    chain = geometry::straight_chain(ribbon, {Vec3(0.1, 0.2, 0.3), straight_frame()});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i <= ribbon.segments; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (geometry::kappa_is_free(ribbon, i)) chain.kappa[k] = 2 * kPi / 1.6 * (1 + 0.01 * normal(random));
      chain.eta[k] = 0.25 + 0.005 * normal(random);
    }
    problem.barrier = 0.01;
    problem.base_fixed.fill(true);
    for (int i = 0; i <= ribbon.segments; ++i) {
      problem.force.push_back(Vec3(normal(random), normal(random), normal(random)));
      problem.anchor.push_back(Vec3(normal(random), normal(random), normal(random)));
      problem.tie.push_back(2);
    }
    constraint::Surroundings surroundings;
    surroundings.contact = {0.25, 0.01, true};
    place_self(ribbon, surroundings, 0.25, true, chain.eta, problem.self);
  }
};

Chain moved(const Chain& chain, const VectorXd& x) {
  Chain out = chain;
  for (std::size_t i = 0; i < out.kappa.size(); ++i) {
    out.kappa[i] += x[2 * static_cast<Index>(i)];
    out.eta[i] += x[2 * static_cast<Index>(i) + 1];
  }
  return out;
}

std::vector<solver::StripPlace> alone(const geometry::Ribbon& ribbon, const Chain& chain, const Kinematics& k) {
  return {{ribbon, chain, k}};
}

struct Linear {
  double value;
  VectorXd gradient, step;
};

Linear linear(const Coil& coil, const Chain& chain) {
  Kinematics k, start;  // loads are counted from the coil as it was
  geometry::forward_kinematics(coil.ribbon, chain, k);
  geometry::forward_kinematics(coil.ribbon, coil.chain, start);
  solver::Touching touching;
  solver::SelfSearch search;
  find_pairs(alone(coil.ribbon, chain, k), coil.problem.self, search, touching.self);
  EXPECT_GT(touching.self.pairs.size(), 20u);
  math::ChainSystem system;
  math::ChainWorkspace work;
  math::ChainStep step;
  linearise(coil.ribbon, coil.problem, chain, k, {}, touching, system);
  EXPECT_TRUE(chain_step(system, work, step));
  Linear out{objective(coil.ribbon, coil.problem, chain, k, start).total() +
                 self_energy(coil.problem.self, touching.self),
             VectorXd(2 * coil.ribbon.node_count()), VectorXd(2 * coil.ribbon.node_count())};
  for (std::size_t i = 0; i < work.gradient.size(); ++i) {
    out.gradient.segment<2>(2 * static_cast<Index>(i)) = work.gradient[i];
    out.step.segment<2>(2 * static_cast<Index>(i)) = step.u[i];
  }
  return out;
}

/// Central differences over a step so short that hardly a pair changes what is nearest in it: there its second
/// derivative jumps, so that the order of an error would say little.
TEST(SelfContact, GradientIsTheSlopeAndHessianItsDerivative) {
  const Coil coil;
  const Linear here = linear(coil, coil.chain);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  VectorXd d = VectorXd::NullaryExpr(here.gradient.size(), [&] { return normal(random); });
  for (int i : {0, coil.ribbon.segments}) d[2 * i] = 0;  // free ends do not fold
  constexpr double kStep = 1e-6;
  const auto at = [&](double h, const VectorXd& way) { return linear(coil, moved(coil.chain, h * way)); };
  const double slope = (at(kStep, d).value - at(-kStep, d).value) / (2 * kStep);
  EXPECT_GT(std::abs(slope), 1);
  EXPECT_NEAR(here.gradient.dot(d) / slope, 1, 1e-6);
  // Along Newton's step the gradient goes to zero, to first order.
  const VectorXd way = here.step / here.step.norm();
  const VectorXd bend = (at(kStep, way).gradient - at(-kStep, way).gradient) / (2 * kStep);
  EXPECT_GT(bend.norm(), 1);
  EXPECT_LT((bend * here.step.norm() + here.gradient).norm(), 1e-5 * here.gradient.norm());
}

/// A way that ends on the far side of another part of the strip is seen, however long it is.
TEST(SelfContact, NothingIsLeaptOver) {
  geometry::RibbonSpec spec;
  spec.length = 2;
  spec.width = 0.1;
  spec.segments = 20;
  const Ribbon ribbon = geometry::make_ribbon(spec);
  constraint::Surroundings surroundings;
  surroundings.contact = {0.003, 0, true};
  Chain open = geometry::straight_chain(ribbon, {Vec3::Zero(), straight_frame()}), closed = open;
  for (std::size_t i = 1; i < 20; ++i) open.kappa[i] = 2.6, closed.kappa[i] = 3.6;  // its ends pass each other
  solver::SelfContact self;
  place_self(ribbon, surroundings, 0.003, true, open.eta, self);
  solver::SelfSearch search;
  solver::SelfContacts from, to;
  Kinematics k;
  geometry::forward_kinematics(ribbon, open, k);
  find_pairs(alone(ribbon, open, k), self, search, from);
  EXPECT_TRUE(from.pairs.empty());
  EXPECT_TRUE(travel(alone(ribbon, open, k), self, from, search, to));
  geometry::forward_kinematics(ribbon, closed, k);
  EXPECT_FALSE(travel(alone(ribbon, closed, k), self, from, search, to));
}

/// Do an edge and a triangle meet? Apart from the solver's test: by where the line meets the plane.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat3 m;
  m << p - q, b - a, c - a;
  if (std::abs(m.determinant()) < 1e-14) return false;
  const Vec3 x = m.inverse() * (p - a);
  return x[0] >= 0 && x[0] <= 1 && x[1] >= 0 && x[2] >= 0 && x[1] + x[2] <= 1;
}

/// Places where facets more than two apart go through each other, by trying all of them.
int crossings(const Ribbon& ribbon, const Chain& chain, bool loop) {
  Kinematics k;
  geometry::forward_kinematics(ribbon, chain, k);
  const int n = ribbon.segments;
  const auto corner = [&](int node, int side) -> Vec3 {
    const auto i = static_cast<std::size_t>(node);
    const double v = (side - 0.5) * ribbon.width;
    return k.r[i] + v * (k.frame[i].col(1) + chain.eta[i] * k.frame[i].col(2));
  };
  int count = 0;
  for (int s = 0; s < n; ++s) {
    const Vec3 c[4] = {corner(s, 0), corner(s, 1), corner(s + 1, 1), corner(s + 1, 0)};
    for (int t = 0; t < n; ++t) {
      const int apart = std::min(std::abs(s - t), loop ? n - std::abs(s - t) : n);
      if (apart <= 2) continue;
      const Vec3 e[4] = {corner(t, 0), corner(t, 1), corner(t + 1, 1), corner(t + 1, 0)};
      for (int i = 0; i < 4; ++i) {
        count += pierces(e[i], e[(i + 1) % 4], c[0], c[1], c[2]) || pierces(e[i], e[(i + 1) % 4], c[0], c[2], c[3]);
      }
    }
  }
  return count;
}

geometry::RibbonSpec loop(int segments, int half_twists) {
  geometry::RibbonSpec spec;
  spec.length = 2 * kPi;
  spec.width = 0.4;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  spec.half_twists = half_twists;
  return spec;
}

/// Twisted by a whole turn and closed, a loop comes to rest with its two inflection rulings end to end, in the shape
/// of a zero; V l/(D w) = 56.908, twist 0.2866 (reference of error 1e-9).
TEST(SelfContact, ALoopOfAWholeTurnBecomesAZero) {
  for (const int segments : {50, 100}) {
    constraint::Surroundings surroundings;
    surroundings.contact = {0.002 * 0.4, 0, true};
    solver::PathOptions options;
    options.loop_path = solver::LoopPath::twist;
    const solver::PathProblem path = make_path(geometry::make_ribbon(loop(segments, 2)), surroundings, options);
    solver::PathState state = start_path(path);
    solver::NewtonWorkspace work;
    while (state.phase != solver::Phase::done) {
      const solver::PathStep step = advance(path, state, work);
      ASSERT_TRUE(step.accepted) << step.failure;
      ASSERT_EQ(crossings(ribbon_of(path, state), state.chain, true), 0) << phase_name(state.phase) << " " << state.t;
    }
    const double energy = solver::elastic_energy(path.ribbon, options.model, state.chain);
    const double value = energy * 2 * kPi / 0.4, error = value / 56.908 - 1;
    const geometry::State shape = geometry::state_of(path.ribbon, state.chain, 0);
    const double twist = geometry::topology(path.ribbon, shape).twist;
    std::printf("  n = %d: V l/(D w) = %.4f, relative error %.1e, twist %.4f, smallest distance / w %.1e\n", segments,
                value, error, twist, state.nearest / 0.4);
    EXPECT_LT(std::abs(error), segments == 50 ? 1.2e-2 : 3e-3);
    EXPECT_NEAR(twist, 0.2866, 2e-3);
    EXPECT_EQ(geometry::kappa_zeros(path.ribbon, geometry::strains(path.ribbon, shape).kappa).size(), 2u);
    EXPECT_GT(state.nearest, 0);
    EXPECT_LT(state.nearest, 0.002 * 0.4);  // it touches
    EXPECT_EQ(state.negative_modes, 0);
    if (is_slow_build()) break;
  }
}

/// Neighbours across a seam that turns the surface over are neighbours: a Moebius band touches nothing.
TEST(SelfContact, AMoebiusBandDoesNotFeelItself) {
  constraint::Surroundings alone, feels;
  feels.contact = {0.02, 0, true};
  const PathEnd a = run_path(loop(50, 1), alone, {}), b = run_path(loop(50, 1), feels, {});
  ASSERT_TRUE(a.done && b.done) << b.failure;
  EXPECT_NEAR(b.energy / a.energy, 1, 1e-9);
  EXPECT_EQ(b.at.touching, 0);
}

}  // namespace
}  // namespace wunderlich::testing
