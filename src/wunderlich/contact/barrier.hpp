/// What keeps two bodies apart: an energy that begins at a small distance and is infinite at none.
#pragma once

#include <cmath>
#include <limits>

namespace wunderlich::contact {

inline constexpr double kLeastShare = 0.1;  ///< of a gap that one step of Newton's leaves

/// -(d - reach)^2 ln(d/reach) of a distance d < reach, with log = ln(d/reach), which is taken once for a point and used
/// for value and slopes. Infinite where log is minus infinity.   @eq Li2020:6
inline double barrier_value(double d, double reach, double log) { return -(d - reach) * (d - reach) * log; }

/// Derivatives with respect to the distance.
struct BarrierSlopes {
  double first, second;
};

/// Those of `barrier_value`, of the same arguments; infinite with it.
inline BarrierSlopes barrier_slopes(double d, double reach, double log) {
  const double less = d - reach, ratio = less / d;
  return {-less * (2 * log + ratio), -2 * log - ratio * (4 - ratio)};
}

/// Value and derivatives with respect to the distance.
struct Barrier {
  double value, first, second;
};

/// The same at any distance: 0 from reach on; infinite (derivatives 0) where d <= 0.
inline Barrier barrier(double d, double reach) {
  if (d >= reach) return {0, 0, 0};
  if (!(d > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double log = std::log(d / reach);
  const BarrierSlopes slopes = barrier_slopes(d, reach, log);
  return {barrier_value(d, reach, log), slopes.first, slopes.second};
}

}  // namespace wunderlich::contact
