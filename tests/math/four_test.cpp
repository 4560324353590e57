// What of math::Four the chain sweep does not exercise, in both of its definitions (with AVX and without).
#include "wunderlich/math/four.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "wunderlich/math/sine.hpp"

namespace wunderlich::testing {
namespace {

using math::Four;
using Lanes = std::array<double, 4>;

Lanes lanes(Four a) { return {a[0], a[1], a[2], a[3]}; }

TEST(Four, TransposesAndMovesOn) {
  Four a{0, 1, 2, 3}, b{10, 11, 12, 13}, c{20, 21, 22, 23}, d{30, 31, 32, 33};
  EXPECT_EQ(lanes(math::moved_on(a, b)), (Lanes{1, 2, 3, 10}));
  math::transpose4(a, b, c, d);
  EXPECT_EQ(lanes(a), (Lanes{0, 10, 20, 30}));
  EXPECT_EQ(lanes(b), (Lanes{1, 11, 21, 31}));
  EXPECT_EQ(lanes(c), (Lanes{2, 12, 22, 32}));
  EXPECT_EQ(lanes(d), (Lanes{3, 13, 23, 33}));
}

TEST(Four, RepeatsTheLastEntryBeyondTheEnd) {
  const std::vector<double> from{5, 6, 7, 8, 9};
  EXPECT_EQ(lanes(math::load(from, 1)), (Lanes{6, 7, 8, 9}));
  EXPECT_EQ(lanes(math::load(from, 2)), (Lanes{7, 8, 9, 9}));
  EXPECT_EQ(lanes(math::load(from, 5)), (Lanes{9, 9, 9, 9}));
}

TEST(Four, IsBelowABoundWhereEveryLaneIs) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(math::all_below(Four{-1, 0, 1, 1.9}, 2));
  for (int lane = 0; lane < 4; ++lane) {
    for (const double value : {2.0, 3.0, kNone}) {
      Lanes x{-1, 0, 1, 1.9};
      x[static_cast<std::size_t>(lane)] = value;
      EXPECT_FALSE(math::all_below(Four{x[0], x[1], x[2], x[3]}, 2));
    }
  }
}

TEST(Four, MixesWithNumbers) {
  const Four x{1, 2, 4, 16};
  EXPECT_EQ(lanes(3 - x / 2 + 1 / x), (Lanes{3.5, 2.5, 1.25, -4.9375}));
  EXPECT_EQ(lanes(math::sqrt(x * x)), (Lanes{1, 2, 4, 16}));
}

TEST(SineCosine, OfFourIsThatOfEach) {
  for (const Four& x : {Four{0.1, -0.6, 0, 0.69}, Four{2, -3, 10, 1}, Four{0.2, 0.71, -0.3, 4}}) {
    const auto [sine, cosine] = math::sine_cosine(x);
    for (int lane = 0; lane < 4; ++lane) {
      EXPECT_NEAR(sine[lane], std::sin(x[lane]), 2e-16);
      EXPECT_NEAR(cosine[lane], std::cos(x[lane]), 2e-16);
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
