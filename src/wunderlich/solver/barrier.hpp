/// The barrier of contact in a distance d that is less than e, of which log = ln(d/e): -(d - e)^2 ln(d/e).
/// @eq Li2020:6
#pragma once

namespace wunderlich::solver {

/// Infinite where log is minus infinity.
inline double barrier_value(double d, double e, double log) { return -(d - e) * (d - e) * log; }

struct BarrierSlopes {
  double first, second;  ///< derivatives
};

inline BarrierSlopes barrier_slopes(double d, double e, double log) {
  const double less = d - e, ratio = less / d;
  return {-less * (2 * log + ratio), -2 * log - ratio * (4 - ratio)};
}

}  // namespace wunderlich::solver
