// Equilibria of rods against closed forms and an independent code.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "baseline/rods.hpp"

namespace wunderlich::testing {
namespace {

/// The independent code's figures, n nodes: C++ discrete elastic rods with exact Hessians; gradient below 1e-8.
TEST(RodEquilibrium, ProblemTAgreesWithAnIndependentCode) {
  for (const auto& [nodes, expected] : {std::pair{50, 0.1513}, {100, 0.1396}, {200, 0.1372}}) {
    const geometry::RibbonSpec spec = problem_t_spec(nodes);
    const Rod sample = rod::make_rod(spec, rod::physical(spec, 0.3, 1e-3));
    rod::State start = rod::straight_state(sample);
    for (Vec3& x : start.x) x.z() += 1e-4 * std::sin(kPi * x.x());
    const PathEnd end = along_path(sample, problem_t_surroundings(nodes), start, 20);
    std::printf("%d %.6f its %d last %.2e grad %.2e neg %d %s\n", nodes, end.energy, end.iterations, end.last.last_step, end.last.gradient, end.last.negative_modes, rod::outcome_name(end.last.outcome));
    ASSERT_TRUE(end.done);
    EXPECT_NEAR(end.energy, expected, 0.02 * expected);
  }
}

}  // namespace
}  // namespace wunderlich::testing
