/// The integral over the width, as a factor on the narrow-limit energy: phi(x), x = w eta'/2.
#pragma once

#include <cmath>
#include <limits>

#include "wunderlich/energy/model.hpp"
#include "wunderlich/math/four.hpp"

namespace wunderlich::energy {

/// A function of the ruling ratio x with two derivatives.
struct WidthFactor {
  double value, first, second;
};

/// sum_{a=0}^{order} x^(2a)/(2a+1): the width integral cut off.   @eq Shen2015:4
inline WidthFactor truncated_factor(int order, double x) {
  // Horner in y = x^2 on F(y), F'(y) and F''(y)/2; then phi = F(x^2).
  const double y = x * x;
  double f = 0, f1 = 0, f2 = 0;
  for (int a = order; a >= 0; --a) {
    f2 = f2 * y + f1;
    f1 = f1 * y + f;
    f = f * y + 1.0 / (2 * a + 1);
  }
  return {f, 2 * x * f1, 2 * f1 + 8 * y * f2};
}

/// The first thirteen terms of atanh(x)/x, to 1e-16 for x^2 < 0.04: F(y), F'(y) and F''(y)/2 at once, y = x^2.
inline WidthFactor small_factor(double x) {
  constexpr auto term = [](int a) {
    const double next = a + 1, after = a + 2;
    return math::Four{1.0 / (2 * a + 1), next / (2 * next + 1), 0.5 * after * next / (2 * after + 1), 0};
  };
  static constexpr math::Four terms[] = {term(0), term(1), term(2), term(3),  term(4),  term(5), term(6),
                                         term(7), term(8), term(9), term(10), term(11), term(12)};
  const double y = x * x;
  const math::Four power = math::all(y);
  math::Four sum = terms[12];
  for (int a = 11; a >= 0; --a) sum = sum * power + terms[a];
  return {sum[0], 2 * x * sum[1], 2 * sum[1] + 8 * y * sum[2]};
}

/// atanh(x)/x, the exact width integral; to 1e-15 for every |x| < 1, infinite beyond.   @eq Shen2015:3
inline WidthFactor exact_factor(double x) {
  const double y = x * x;
  if (y < 0.04) return small_factor(x);  // free of cancellation
  if (y >= 1) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {kInfinity, std::copysign(kInfinity, x), kInfinity};
  }
  const double slope = 1 / ((1 - x) * (1 + x));  // of atanh
  const double value = 0.5 * std::log((1 + x) / (1 - x)) / x;
  const double first = (slope - value) / x;
  return {value, first, 2 * (slope * slope - first / x)};
}

/// The factor of a model; 1 in the Sadowsky limit.
inline WidthFactor width_factor(const Model& model, double x) {
  if (model.elastic == Elastic::wunderlich) return exact_factor(x);
  if (model.elastic == Elastic::truncated) return truncated_factor(model.taylor_order, x);
  return {1, 0, 0};
}

/// -ln(1 - x^2): keeps rulings from meeting inside the strip; infinite from |x| = 1 on.   @eq Shen2015:13
inline WidthFactor ruling_barrier(double x) {
  const double gap = (1 - x) * (1 + x);
  if (!(gap > 0)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {kInfinity, std::copysign(kInfinity, x), kInfinity};
  }
  const double value = gap > 0.5 ? -std::log1p(-x * x) : -std::log(gap);
  const double inverse = 1 / gap;
  return {value, 2 * x * inverse, 2 * (1 + x * x) * inverse * inverse};
}

}  // namespace wunderlich::energy
