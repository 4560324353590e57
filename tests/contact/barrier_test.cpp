/// The barrier of contact: a value known in closed form, its ends, and both derivatives against differences.
#include "wunderlich/contact/barrier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace wunderlich::contact {
namespace {

constexpr double kReach = 2e-3;

TEST(Barrier, Value) {
  const double share = 1 / std::numbers::e;  // ln = -1
  EXPECT_NEAR(barrier(kReach * share, kReach).value, kReach * kReach * (1 - share) * (1 - share),
              1e-20);  // @eq Li2020:6
}

TEST(Barrier, BeginsSmoothlyAndNeverEnds) {
  const Barrier near = barrier((1 - 1e-6) * kReach, kReach), beyond = barrier(kReach, kReach);
  EXPECT_GT(near.value, 0);
  EXPECT_LT(near.value, 1e-17 * kReach * kReach);
  EXPECT_LT(std::abs(near.first), 1e-11 * kReach);
  EXPECT_LT(near.second, 1e-5);
  EXPECT_EQ(beyond.value, 0);
  EXPECT_EQ(beyond.first, 0);
  EXPECT_EQ(beyond.second, 0);
  for (const double d : {0.0, -kReach}) EXPECT_TRUE(std::isinf(barrier(d, kReach).value));
  EXPECT_TRUE(std::isinf(barrier_value(0, kReach, -std::numeric_limits<double>::infinity())));
}

TEST(Barrier, Derivatives) {
  for (const double share : {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99}) {
    const double d = share * kReach, h = 1e-4 * std::fmin(d, kReach - d);
    const Barrier here = barrier(d, kReach), more = barrier(d + h, kReach), less = barrier(d - h, kReach);
    EXPECT_NEAR((more.value - less.value) / (2 * h), here.first, 1e-6 * std::abs(here.first)) << share;
    EXPECT_NEAR((more.first - less.first) / (2 * h), here.second, 1e-6 * std::abs(here.second)) << share;
  }
}

}  // namespace
}  // namespace wunderlich::contact
