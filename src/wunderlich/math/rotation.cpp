#include "wunderlich/math/rotation.hpp"

#include <array>
#include <numbers>

namespace wunderlich::math {

namespace {

using std::numbers::pi;

/// c(s) = (1 - x cot x)/s with x = sqrt(s)/2, and dc/ds.
struct CotangentFactor {
  double value, first;
};

/// By the partial fractions x cot x = 1 - 2 sum_m s/((2 pi m)^2 - s): two of them exactly, the rest as a power
/// series whose ratio is s/(36 pi^2), so there is neither cancellation near 0 nor trouble at pi.
/// Coefficient k is 2 (zeta(2k) - 1 - 4^-k)/(2 pi)^(2k).
CotangentFactor cotangent_factor(double s) {
  static constexpr std::array<double, 12> kRest{
      2.00075935568722260e-02, 2.54381206886256203e-05, 5.58456839049441506e-08, 1.40882415747610478e-10,
      3.75671620021579791e-13, 1.02801253753604606e-15, 2.85002212921379108e-18, 7.95557541071984463e-21,
      2.22893266455370120e-23, 6.25747115080577254e-26, 1.75867304929096802e-28, 4.94584695005793831e-31};
  double rest = 0, rest_first = 0;
  for (std::size_t k = kRest.size(); k-- > 0;) {
    rest_first = rest_first * s + rest;
    rest = rest * s + kRest[k];
  }
  const double near = 1 / (4 * pi * pi - s), far = 1 / (16 * pi * pi - s);
  return {2 * (near + far) + rest, 2 * (near * near + far * far) + rest_first};
}

}  // namespace

// By the bisector, which stays exact where 1 + from . to cancels. Eigen's FromTwoVectors asks a singular value
// decomposition for the axis of opposite vectors, and compiling it takes longer than the rest of a file.
Quat shortest_rotation(const Vec3& from, const Vec3& to) {
  const Vec3 bisector = from + to;
  const double length = bisector.norm();
  const Vec3 axis = length < 1e-12 ? from.unitOrthogonal() : Vec3(from.cross(bisector) / length);
  return Quat(0.5 * length, axis.x(), axis.y(), axis.z());
}

Mat3 left_jacobian(const Vec3& v) {
  const double s = v.squaredNorm();
  const double angle = std::sqrt(s);
  double first = 0.5, second = 1.0 / 6;
  if (s < 0.25) {
    first = 0.5 - s * (1.0 / 24 - s * (1.0 / 720 - s * (1.0 / 40320 - s * (1.0 / 3628800 - s / 479001600))));
    second = 1.0 / 6 - s * (1.0 / 120 - s * (1.0 / 5040 - s * (1.0 / 362880 - s * (1.0 / 39916800 - s / 6227020800))));
  } else {
    first = (1 - std::cos(angle)) / s;
    second = (angle - std::sin(angle)) / (s * angle);
  }
  const Mat3 cross = skew(v);
  return Mat3::Identity() + first * cross + second * cross * cross;
}

Mat3 left_jacobian_inverse(const Vec3& v) {
  const double s = v.squaredNorm();
  const double c = cotangent_factor(s).value;
  return (1 - c * s) * Mat3::Identity() - 0.5 * skew(v) + c * v * v.transpose();
}

Mat3 left_jacobian_inverse_derivative(const Vec3& v, const Vec3& y) {
  const auto [c, c_first] = cotangent_factor(v.squaredNorm());
  const Vec3 once = v.cross(y);
  const Vec3 twice = v.cross(once);
  return 0.5 * skew(y) - c * (skew(once) + skew(v) * skew(y)) + 2 * c_first * twice * v.transpose();
}

}  // namespace wunderlich::math
