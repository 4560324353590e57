// A narrow strip cantilever under a force in its own plane leaves the plane where Sadowsky's strip does.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "solver/paths.hpp"
#include "solver/reference.hpp"
#include "wunderlich/solver/newton.hpp"

namespace wunderlich::testing {
namespace {

using geometry::Chain;
using geometry::Ribbon;
using solver::ChainProblem;

/// Length 1, D w = 1, clamped along +x at its start, normal +z.
Ribbon narrow_strip(double width, int segments) {
  geometry::RibbonSpec spec;
  spec.width = width;
  spec.bending_stiffness = 1 / width;
  spec.segments = segments;
  spec.clamped = {true, false};
  return geometry::make_ribbon(spec);
}

/// A force on the tip in the plane of the flat strip, across it.
ChainProblem loaded(const Ribbon& ribbon, double load) {
  ChainProblem problem;
  problem.barrier = 1e-9;
  problem.base_fixed.fill(true);
  problem.force.assign(static_cast<std::size_t>(ribbon.node_count()), Vec3::Zero());
  problem.force.back() = Vec3(0, load, 0);
  return problem;
}

/// Negative modes of the flat strip with these rulings: they cost nothing there, but decide how it can leave the plane.
int negative_modes(const Ribbon& ribbon, Chain chain, double load) {
  chain.kappa.assign(chain.kappa.size(), 0.0);
  geometry::Kinematics k;
  geometry::forward_kinematics(ribbon, chain, k);
  math::ChainSystem system;
  math::ChainWorkspace work;
  math::ChainStep step;
  linearise(ribbon, loaded(ribbon, load), chain, k, {}, {}, system);
  EXPECT_TRUE(chain_step(system, work, step));
  return step.negative_pivots;
}

/// The load at which the flat strip with these rulings first has a negative mode. As a function of the rulings it is
/// least at those of the buckling mode, hence an upper bound, to second order in what they are off.
double first_unstable_load(const Ribbon& ribbon, const Chain& chain) {
  double stable = 0, unstable = 20;
  EXPECT_EQ(negative_modes(ribbon, chain, stable), 0);
  EXPECT_GT(negative_modes(ribbon, chain, unstable), 0);
  while (unstable - stable > 1e-7) {
    const double middle = 0.5 * (stable + unstable);
    (negative_modes(ribbon, chain, middle) > 0 ? unstable : stable) = middle;
  }
  return 0.5 * (stable + unstable);
}

/// Follows the buckled strip down towards the load where it is flat again, and takes its rulings there.
double critical_load(double width, int segments) {
  const Ribbon ribbon = narrow_strip(width, segments);
  Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), straight_frame()});
  // Rulings at a constant slope: unstable from 16/9 sqrt(3) pi^2/4 = 7.6 on at best.
  for (std::size_t i = 0; i + 1 < chain.kappa.size(); ++i) {
    chain.kappa[i] = std::cos(0.5 * kPi * ribbon.node_u[i]);
    chain.eta[i] = -0.58 * std::min(1.0, 4 * std::sin(kPi * ribbon.node_u[i]));
  }
  EXPECT_GT(first_unstable_load(ribbon, chain), 7.5);
  solver::NewtonWorkspace work;
  std::vector<double> multipliers;
  for (const double load : {12.0, 9.0, 8.0, 7.6, 7.3}) {
    const auto report = minimise(ribbon, loaded(ribbon, load), {}, chain, multipliers, work);
    EXPECT_TRUE(report.converged()) << load;
    EXPECT_EQ(report.negative_modes, 0);
  }
  geometry::Kinematics k;
  geometry::forward_kinematics(ribbon, chain, k);
  EXPECT_GT(std::abs(k.r.back().z()), 0.1);  // still out of the plane
  return first_unstable_load(ribbon, chain);
}

TEST(LateralBuckling, TendsToSadowsky) {
  const double exact = reference("analytic.json").at("f_lateral_buckling").at("P_l2_over_B_sadowsky");
  // The strip's width stiffens it, in proportion: the limit of no width is Sadowsky's.
  std::vector<double> excess;
  const std::vector<double> widths{0.08, 0.04, 0.02, 0.01};
  for (const double width : widths) {
    const double load = critical_load(width, 400);
    excess.push_back(load / exact - 1);
    std::cout << "  lateral buckling, w/l = " << width << ": P l^2/(D w) = " << load << ", above Sadowsky's by "
              << excess.back() << "\n";
    EXPECT_GT(excess.back(), 0);
    EXPECT_LT(excess.back(), 0.7 * width);
  }
  EXPECT_LT(std::abs(2 * excess[3] - excess[2]), 1e-3);  // extrapolated to no width
}

}  // namespace
}  // namespace wunderlich::testing
