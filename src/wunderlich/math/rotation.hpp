/// Rotations: quaternion exponential and logarithm, their Jacobians and second derivatives.
///
/// A rotation vector v turns by |v| radians about v. With exp the map to unit quaternions,
///   exp(v + dv) = exp(v) exp(J_r(v) dv) = exp(J_l(v) dv) exp(v)   to first order in dv,
///   log(exp(v) exp(w)) = v + J_r^{-1}(v) w,   log(exp(w) exp(v)) = v + J_l^{-1}(v) w   to first order in w,
/// and J_r(v) = J_l(v)^T = J_l(-v).
#pragma once

#include <cmath>

#include "wunderlich/base/types.hpp"

namespace wunderlich::math {

/// The matrix of a cross product: skew(a) b = a x b.
inline Mat3 skew(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Unit quaternion of a rotation vector [rad]; accurate for any length.
inline Quat exp_map(const Vec3& v) {
  const double angle2 = v.squaredNorm();
  if (angle2 < 1e-10) {
    const double scale = 0.5 - angle2 / 48;
    return Quat(1 - angle2 / 8, scale * v.x(), scale * v.y(), scale * v.z());
  }
  const double angle = std::sqrt(angle2);
  const double scale = std::sin(0.5 * angle) / angle;
  return Quat(std::cos(0.5 * angle), scale * v.x(), scale * v.y(), scale * v.z());
}

/// Rotation vector of a quaternion, of length at most pi [rad]. The sign and the norm of q do not matter.
/// Stable near 0 and near pi; at pi exactly one of the two vectors.
inline Vec3 log_map(const Quat& q) {
  const Vec3 vec = q.w() < 0 ? Vec3(-q.vec()) : Vec3(q.vec());
  const double w = std::abs(q.w());
  const double sine2 = vec.squaredNorm();
  if (sine2 < 1e-10 * w * w) {
    const double ratio2 = sine2 / (w * w);
    return vec * (2 / w * (1 - ratio2 / 3 + ratio2 * ratio2 / 5));
  }
  const double sine = std::sqrt(sine2);
  return vec * (2 * std::atan2(sine, w) / sine);
}

/// The smallest rotation that takes the unit vector `from` to the unit vector `to`. Of opposite vectors (nearer to it
/// than 1e-12) the half turn about one direction square to `from`, which then is arbitrary but always the same.
Quat shortest_rotation(const Vec3& from, const Vec3& to);

/// J_l(v); see the head of this file.
Mat3 left_jacobian(const Vec3& v);
inline Mat3 right_jacobian(const Vec3& v) { return left_jacobian(-v); }

/// J_l^{-1}(v) for |v| < 2 pi, to rounding for |v| <= pi.
Mat3 left_jacobian_inverse(const Vec3& v);
inline Mat3 right_jacobian_inverse(const Vec3& v) { return left_jacobian_inverse(-v); }

/// d(J_l^{-1}(v) y)/dv for a fixed y: what a second derivative of log needs.
Mat3 left_jacobian_inverse_derivative(const Vec3& v, const Vec3& y);
/// d(J_r^{-1}(v) y)/dv for a fixed y.
inline Mat3 right_jacobian_inverse_derivative(const Vec3& v, const Vec3& y) {
  return -left_jacobian_inverse_derivative(-v, y);
}

}  // namespace wunderlich::math
