/// The fold of one hinge as a rotation, in the coordinates (kappa, eta), with its first two derivatives.
///
/// With gamma = 0 and tau = kappa eta the rotation vector between neighbouring frames is h kappa (0, 1, eta):
/// a turn by h kappa sqrt(1 + eta^2) about the ruling, where h is the hinge length. No constraint is left.
/// @eq Shen2015:14 @eq Shen2015:15 (solved for, not enforced)
#pragma once

#include "wunderlich/base/types.hpp"
#include "wunderlich/math/sine.hpp"

namespace wunderlich::geometry {

/// Half-angle form of the fold; cheap to compute once and to differentiate.
template <class Real>
struct Fold {
  Real s2;        ///< 1 + eta^2
  Real s;         ///< |ruling|
  Real inverse;   ///< 1 / |ruling|
  Real half_sin;  ///< sin and cos of half the fold angle h kappa s
  Real half_cos;
};

/// The turn by kappa over a hinge's length [m] about the ruling (0, 1, eta).
template <class Real>
inline Fold<Real> make_fold(Real hinge_length, Real kappa, Real eta) {
  const Real s2 = 1 + eta * eta, s = math::sqrt(s2);
  const auto [sine, cosine] = math::sine_cosine(0.5 * hinge_length * kappa * s);
  return {s2, s, 1 / s, sine, cosine};
}

/// The fold as a quaternion (0, f, f eta, half_cos): it has no component along the normal. This is f.
template <class Real>
inline Real sine_part(const Fold<Real>& fold) {
  return fold.half_sin * fold.inverse;
}

/// The folds of the nodes that follow each of four: `after` goes on where `here` ends.
inline Fold<math::Four> moved_on(const Fold<math::Four>& here, const Fold<math::Four>& after) {
  return {math::moved_on(here.s2, after.s2), math::moved_on(here.s, after.s),
          math::moved_on(here.inverse, after.inverse), math::moved_on(here.half_sin, after.half_sin),
          math::moved_on(here.half_cos, after.half_cos)};
}

/// frame of the next segment = frame * fold_rotation
inline Quat fold_rotation(const Fold<double>& fold, double eta) {
  const double f = sine_part(fold);
  return Quat(fold.half_cos, 0, f, f * eta);
}

/// Components along d1, d2, d3 of the frame before the fold.
template <class Real>
struct InFrame {
  Real x, y, z;
};

/// First derivatives of the rotation (left increments) and the symmetric second ones, in the parent's axes.
template <class Real>
struct FoldDerivatives {
  InFrame<Real> kappa, eta;          ///< theta = kappa_axis dkappa + eta_axis deta + ...
  InFrame<Real> kappa_eta, eta_eta;  ///< ... + kappa_eta dkappa deta + eta_eta deta^2 / 2
};

/// Of a fold of `make_fold`, h its hinge's length [m], at the same kappa [1/m] and eta.
template <class Real>
inline FoldDerivatives<Real> fold_derivatives(const Fold<Real>& fold, Real h, Real kappa, Real eta) {
  const Real sine = 2 * fold.half_sin * fold.half_cos;
  const Real versine = 2 * fold.half_sin * fold.half_sin;  // 1 - cos
  const Real cosine = 1 - versine;
  const Real i1 = fold.inverse, i2 = i1 * i1, hk = h * kappa;
  const Real a = hk * eta * i2, b = sine * i1 * i2, c = versine * i2;
  FoldDerivatives<Real> d;
  d.kappa = {0 * h, h, h * eta};
  d.eta = {c, a - b * eta, a * eta + b};
  const Real ak = h * eta * i2, bk = h * cosine * i2, ck = h * sine * i1;
  d.kappa_eta = {0.5 * ck, 0.5 * (ak - bk * eta), 0.5 * (h + ak * eta + bk)};
  const Real turn_eta = hk * eta * i1;  // d(angle)/d(eta)
  const Real ae = hk * (1 - eta * eta) * i2 * i2;
  const Real be = (cosine * turn_eta * i1 - 3 * sine * eta * i1 * i2) * i2;
  const Real ce = (sine * turn_eta - 2 * versine * eta * i2) * i2;
  d.eta_eta = {ce, ae - be * eta - b, ae * eta + a + be};
  return d;
}

}  // namespace wunderlich::geometry
