/// Sine and cosine together, faster than the library's where the angle is small, as it is between neighbouring hinges.
#pragma once

#include "wunderlich/math/four.hpp"

namespace wunderlich::math {

/// Sine and cosine of one angle, or of four.
template <class Real>
struct SineCosine {
  Real sine, cosine;
};

/// To rounding for every x [rad]: Taylor series below 0.7 (what they leave out is below 1e-17), the library beyond.
template <class Real>
inline SineCosine<Real> sine_cosine(Real x) {
  const Real y = x * x;
  if (!all_below(y, 0.49)) return {sin(x), cos(x)};
  constexpr double s3 = -1.0 / 6, s5 = s3 / -20, s7 = s5 / -42, s9 = s7 / -72, s11 = s9 / -110, s13 = s11 / -156,
                   s15 = s13 / -210;
  constexpr double c2 = -1.0 / 2, c4 = c2 / -12, c6 = c4 / -30, c8 = c6 / -56, c10 = c8 / -90, c12 = c10 / -132,
                   c14 = c12 / -182, c16 = c14 / -240;
  const Real s = y * (s3 + y * (s5 + y * (s7 + y * (s9 + y * (s11 + y * (s13 + y * s15))))));
  const Real c = y * (c2 + y * (c4 + y * (c6 + y * (c8 + y * (c10 + y * (c12 + y * (c14 + y * c16)))))));
  return {x + x * s, 1 + c};
}

}  // namespace wunderlich::math
