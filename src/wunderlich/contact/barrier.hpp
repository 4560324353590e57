/// What keeps two bodies apart: an energy that begins at a small distance and is infinite at none.
#pragma once

#include <cmath>
#include <limits>

namespace wunderlich::contact {

/// Value and derivatives with respect to the distance.
struct Barrier {
  double value, first, second;
};

/// -(d - reach)^2 ln(d/reach) for d < reach, 0 beyond; infinite (derivatives 0) where d <= 0.   @eq Li2020:6
inline Barrier barrier(double d, double reach) {
  if (d >= reach) return {0, 0, 0};
  if (!(d > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double log = std::log(d / reach), less = d - reach;
  return {-less * less * log, -2 * less * log - less * less / d, -2 * log - 4 * less / d + less * less / (d * d)};
}

}  // namespace wunderlich::contact
