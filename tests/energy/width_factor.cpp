// The width factor against independent evaluations in long double and against its own definition.
#include "wunderlich/energy/width_factor.hpp"

#include <gtest/gtest.h>

#include "support/taylor.hpp"

namespace wunderlich::testing {
namespace {

using energy::Elastic;
using energy::Model;
using WidthFactor = energy::WidthFactor<double>;

/// The series of atanh(x)/x and its derivatives, summed to the end in extended precision.
void series(long double x, long double* out) {
  out[0] = out[1] = out[2] = 0;
  long double power = 1;  // x^(2a)
  for (int a = 0; a < 20000 && power > 1e-30L; ++a) {
    const long double c = power / (2 * a + 1);
    out[0] += c;
    if (a > 0) {
      out[1] += 2 * a * c / x;
      out[2] += 2.0L * a * (2 * a - 1) * c / (x * x);
    }
    power *= x * x;
  }
}

// @eq Shen2015:3
TEST(WidthFactor, AgreesWithTheSeriesToRounding) {
  for (double x : {1e-9, 1e-3, 0.05, 0.19, 0.1999999, 0.2000001, 0.21, 0.5, 0.9, 0.99, -0.3, -0.95}) {
    SCOPED_TRACE(x);
    long double expected[3];
    series(static_cast<long double>(x), expected);
    const WidthFactor phi = energy::exact_factor(x);
    EXPECT_NEAR(phi.value / static_cast<double>(expected[0]), 1, 1e-15);
    // Written with the slope of atanh, the derivatives lose a few digits just above the switch to the series.
    EXPECT_NEAR(phi.first / static_cast<double>(expected[1]), 1, 2e-14);
    EXPECT_NEAR(phi.second / static_cast<double>(expected[2]), 1, 2e-13);
  }
}

TEST(WidthFactor, HoldsCloseToOne) {
  for (double gap : {1e-3, 1e-8, 1e-13}) {
    const double x = 1 - gap;
    const long double exact_gap = 1.0L - static_cast<long double>(x);
    const long double value = 0.5L * std::log((2 - exact_gap) / exact_gap) / static_cast<long double>(x);
    EXPECT_NEAR(energy::exact_factor(x).value / static_cast<double>(value), 1, 1e-14);
    const long double slope = 1 / (exact_gap * (2 - exact_gap));
    EXPECT_NEAR(energy::exact_factor(x).first / static_cast<double>((slope - value) / static_cast<long double>(x)), 1,
                1e-13);
  }
  EXPECT_TRUE(std::isinf(energy::exact_factor(1).value));
  EXPECT_TRUE(std::isinf(energy::exact_factor(-1.5).value));
  EXPECT_TRUE(std::isinf(energy::ruling_barrier(1).value));
}

// @eq Shen2015:4
TEST(WidthFactor, TruncatedSeriesIsThePrintedSum) {
  for (int order : {0, 1, 2, 5, 9}) {
    for (double x : {0.0, 0.4, -1.3}) {
      double sum = 0;
      for (int a = 0; a <= order; ++a) sum += std::pow(x, 2 * a) / (2 * a + 1);
      EXPECT_NEAR(energy::truncated_factor(order, x).value, sum, 1e-14 * sum);
    }
  }
}

TEST(WidthFactor, TruncatedSeriesTendsToTheLogarithm) {
  const double x = 0.6;
  double last = 1;
  for (int order = 1; order < 12; ++order) {
    const double error = energy::exact_factor(x).value - energy::truncated_factor(order, x).value;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.36 * last);  // ratio x^2 of the geometric tail
    last = error;
  }
}

// @eq Sadowsky1930
TEST(WidthFactor, SadowskyIsConstant) {
  const WidthFactor phi = energy::width_factor(Model{Elastic::sadowsky, 5, {}}, 0.7);
  EXPECT_EQ(phi.value, 1);
  EXPECT_EQ(phi.first, 0);
  EXPECT_EQ(phi.second, 0);
}

TEST(WidthFactor, DerivativesOfEveryKind) {
  const auto check = [](auto&& factor) {
    for (double x : {0.03, -0.35, 0.8}) {
      SCOPED_TRACE(x);
      const auto value = [&](double h) { return Eigen::VectorXd::Constant(1, factor(x + h).value).eval(); };
      const auto first = [&](double h) { return Eigen::VectorXd::Constant(1, factor(x + h).first).eval(); };
      expect_derivative(value, Eigen::VectorXd::Constant(1, factor(x).first));
      expect_derivative(first, Eigen::VectorXd::Constant(1, factor(x).second));
    }
  };
  check([](double x) { return energy::exact_factor(x); });
  check([](double x) { return energy::truncated_factor(5, x); });
  check([](double x) { return energy::ruling_barrier(x); });
}

// The wall begins without a jump in what is used of it, and keeps what it keeps off well above rounding.
TEST(WidthFactor, BarrierEndsInAWall) {
  const double edge = std::sqrt(1 - 1e-3);
  const auto walled = [](double x) { return energy::ruling_barrier(x, 1e-3); };
  const WidthFactor before = walled(edge - 1e-12), after = walled(edge + 1e-12);
  EXPECT_NEAR(after.value / before.value, 1, 1e-8);
  EXPECT_NEAR(after.first / before.first, 1, 1e-6);
  EXPECT_NEAR(after.second / before.second, 1, 1e-4);
  for (const double x : {0.9996, -0.9999, 0.99999}) {
    SCOPED_TRACE(x);
    const double h = 1e-4 * (1 - std::abs(x));
    const auto value = [&](double at) { return walled(at).value; };
    const auto first = [&](double at) { return walled(at).first; };
    EXPECT_NEAR((value(x + h) - value(x - h)) / (2 * h) / first(x), 1, 1e-6);
    EXPECT_NEAR((first(x + h) - first(x - h)) / (2 * h) / walled(x).second, 1, 1e-6);
  }
  EXPECT_GT(walled(1 - 1e-7).first, 1e18);  // a logarithm's is 1e7
}

/// Four arguments at once: all in reach of the series, none, some, and one where the energy is infinite.
TEST(WidthFactor, OfFourIsThatOfEach) {
  const auto check = [](const auto& factor) {
    for (const math::Four& x :
         {math::Four{1e-9, 0.03, -0.19, 0.0}, math::Four{0.3, -0.5, 0.9, -0.99}, math::Four{0.1, -0.7, 0.1999, 0.2001},
          math::Four{0.1, 1.0, -1.5, 0.6}, math::Four{0.1, 0.9999, -0.3, -0.999}}) {
      const energy::WidthFactor<math::Four> four = factor(x);
      for (int lane = 0; lane < 4; ++lane) {
        SCOPED_TRACE(x[lane]);
        const WidthFactor one = factor(x[lane]);
        EXPECT_DOUBLE_EQ(four.value[lane], one.value);
        EXPECT_DOUBLE_EQ(four.first[lane], one.first);
        EXPECT_DOUBLE_EQ(four.second[lane], one.second);
      }
    }
  };
  for (const Elastic elastic : {Elastic::wunderlich, Elastic::truncated, Elastic::sadowsky}) {
    check([&](auto x) { return energy::width_factor(Model{elastic, 5, {}}, x); });
  }
  check([](auto x) { return energy::ruling_barrier(x); });
  check([](auto x) { return energy::ruling_barrier(x, 1e-3); });
}

// @eq Shen2015:13
TEST(WidthFactor, BarrierIsTheLogarithm) {
  for (double x : {1e-9, 0.3, 0.71, -0.999}) {
    const auto y = static_cast<long double>(x);
    EXPECT_NEAR(energy::ruling_barrier(x).value / static_cast<double>(-std::log1p(-y * y)), 1, 1e-14);
  }
}

}  // namespace
}  // namespace wunderlich::testing
