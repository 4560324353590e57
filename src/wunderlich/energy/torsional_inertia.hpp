/// The paper's guiding term E_I: what a segment's turn about its own tangent costs against the turn it would keep.
#pragma once

#include <cmath>

#include "wunderlich/base/types.hpp"
#include "wunderlich/geometry/ribbon.hpp"

namespace wunderlich::energy {

/// Derivatives in a segment's rotation vector theta.
struct TurnTerms {
  Vec3 gradient;
  Mat3 hessian;
};

/// Angle [rad] within half a turn of the turn about the tangent that takes `carried` to `frame`, once the smallest
/// rotation between their tangents is taken off.
inline double turn_between(const Quat& carried, const Quat& frame) {
  const Quat p = carried.conjugate() * frame;
  return 2 * std::atan2(p.w() < 0 ? -p.z() : p.z(), std::abs(p.w()));
}

/// Derivatives of `weight` turn_between^2.   @eq Shen2015:5.1
inline TurnTerms torsional_inertia(double weight, const Quat& carried, const Quat& frame) {
  const Quat p = carried.conjugate() * frame;
  const double x = p.x(), y = p.y(), z = p.z(), w = p.w(), n = z * z + w * w;
  const Vec3 dz(-0.5 * y, 0.5 * x, 0.5 * w), dw(-0.5 * x, -0.5 * y, -0.5 * z);
  const double angle = turn_between(carried, frame);
  const Vec3 slope = (2 / n) * (w * dz - z * dw);
  // Second derivatives of p along exp(theta) are -p |theta|^2/4 and drop out of atan2.
  const double zz = -4 * z * w / (n * n), zw = 2 * (z * z - w * w) / (n * n);
  const Mat3 mixed = dz * dw.transpose();
  const Mat3 curvature = zz * (dz * dz.transpose() - dw * dw.transpose()) + zw * (mixed + mixed.transpose());
  return {2 * weight * angle * slope, 2 * weight * (slope * slope.transpose() + angle * curvature)};
}

/// Moment of inertia of a segment's cross section about the centerline, rho w^3 l/12 [kg m^2].   @eq Shen2015:5
inline double turn_inertia(const geometry::Ribbon& ribbon, std::size_t segment) {
  return ribbon.area_density * ribbon.width * ribbon.width * ribbon.width * ribbon.rest_length[segment] / 12;
}

}  // namespace wunderlich::energy
