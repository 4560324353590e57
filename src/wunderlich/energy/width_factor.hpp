/// The integral over the width, as a factor on the narrow-limit energy: phi(x), x = w eta'/2.
#pragma once

#include <cmath>
#include <limits>

#include "wunderlich/energy/model.hpp"
#include "wunderlich/math/four.hpp"

namespace wunderlich::energy {

/// A function of the ruling ratio x with two derivatives.
template <class Real>
struct WidthFactor {
  Real value, first, second;
};

namespace detail {

/// Series to `kSeriesOrder` are exact to 1e-16, derivatives and all, for x^2 below this.
inline constexpr double kSeriesBound = 0.04;
inline constexpr int kSeriesOrder = 14;

/// f at each of four x. Branches that the lanes do not share are taken so.
template <class Function>
inline WidthFactor<math::Four> by_lane(const Function& f, math::Four x) {
  const WidthFactor<double> a = f(x[0]), b = f(x[1]), c = f(x[2]), d = f(x[3]);
  return {math::Four{a.value, b.value, c.value, d.value}, math::Four{a.first, b.first, c.first, d.first},
          math::Four{a.second, b.second, c.second, d.second}};
}

}  // namespace detail

/// sum_{a=0}^{order} x^(2a)/(2a+1): the width integral cut off.   @eq Shen2015:4
template <class Real>
inline WidthFactor<Real> truncated_factor(int order, Real x) {
  // Horner in y = x^2 on F(y), F'(y) and F''(y)/2; then phi = F(x^2).
  const Real y = x * x;
  Real f = 0 * y, f1 = f, f2 = f;
#pragma GCC unroll 16
  for (int a = order; a >= 0; --a) {
    f2 = f2 * y + f1;
    f1 = f1 * y + f;
    f = f * y + 1.0 / (2 * a + 1);
  }
  return {f, 2 * x * f1, 2 * f1 + 8 * y * f2};
}

namespace detail {

inline WidthFactor<double> infinite(double x) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {kInfinity, std::copysign(kInfinity, x), kInfinity};
}

/// atanh(x)/x where cancellation does no harm.
inline WidthFactor<double> logarithmic_factor(double x) {
  const double slope = 1 / ((1 - x) * (1 + x));  // of atanh
  const double value = 0.5 * std::log((1 + x) / (1 - x)) / x;
  const double first = (slope - value) / x;
  return {value, first, 2 * (slope * slope - first / x)};
}

}  // namespace detail

/// atanh(x)/x, the exact width integral; to 1e-15 for every |x| < 1, infinite beyond.   @eq Shen2015:3
inline WidthFactor<double> exact_factor(double x) {
  if (x * x < detail::kSeriesBound) return truncated_factor(detail::kSeriesOrder, x);
  return x * x < 1 ? detail::logarithmic_factor(x) : detail::infinite(x);
}
inline WidthFactor<math::Four> exact_factor(math::Four x) {
  if (math::all_below(x * x, detail::kSeriesBound)) return truncated_factor(detail::kSeriesOrder, x);
  return detail::by_lane([](double lane) { return exact_factor(lane); }, x);
}

/// The factor of a model; 1 in the Sadowsky limit.
template <class Real>
inline WidthFactor<Real> width_factor(const Model& model, Real x) {
  if (model.elastic == Elastic::wunderlich) return exact_factor(x);
  return truncated_factor(model.elastic == Elastic::truncated ? model.taylor_order : 0, x);
}

namespace detail {

/// -ln(1 - x^2), |x| < 1.
inline double log_barrier(double x) {
  const double gap = (1 - x) * (1 + x);
  return gap > 0.5 ? -std::log1p(-x * x) : -std::log(gap);
}
inline math::Four log_barrier(math::Four x) {
  const math::Four y = x * x;
  if (!math::all_below(y, kSeriesBound)) return math::by_lane([](double lane) { return log_barrier(lane); }, x);
  math::Four sum = 0 * y;
#pragma GCC unroll 16
  for (int a = kSeriesOrder; a >= 1; --a) sum = (sum + 1.0 / a) * y;
  return sum;
}

/// The barrier where it is finite.
template <class Real>
inline WidthFactor<Real> finite_barrier(Real x) {
  const Real inverse = 1 / ((1 - x) * (1 + x));
  return {log_barrier(x), 2 * x * inverse, 2 * (1 + x * x) * inverse * inverse};
}

/// Adds (wall/(1 - x^2) - 1)^3 where that is positive.
inline void add_wall(double x, double wall, WidthFactor<double>& barrier) {
  const double gap = (1 - x) * (1 + x);
  if (!(gap < wall)) return;
  const double excess = wall / gap - 1, slope = 2 * x * wall / (gap * gap);
  barrier.value += excess * excess * excess;
  barrier.first += 3 * excess * excess * slope;
  barrier.second += 6 * excess * slope * slope + 3 * excess * excess * (2 + 8 * x * x / gap) * wall / (gap * gap);
}

}  // namespace detail

/// -ln(1 - x^2): keeps rulings from meeting inside the strip; infinite from |x| = 1 on.   @eq Shen2015:13
/// Where 1 - x^2 < `wall` it turns into a wall. In motions the bound takes up impulses, a force the larger the shorter
/// the step: against the logarithm alone 1 - |x| would fall with the step's length, down to rounding.
inline WidthFactor<double> ruling_barrier(double x, double wall = 0) {
  if (!(x * x < 1)) return detail::infinite(x);
  WidthFactor<double> barrier = detail::finite_barrier(x);
  detail::add_wall(x, wall, barrier);
  return barrier;
}
// Inlined, so that whoever asks for derivatives alone pays for no logarithm.
[[gnu::always_inline]] inline WidthFactor<math::Four> ruling_barrier(math::Four x, double wall = 0) {
  if (math::all_below(x * x, 1 - wall)) return detail::finite_barrier(x);
  return detail::by_lane([wall](double lane) { return ruling_barrier(lane, wall); }, x);
}

}  // namespace wunderlich::energy
