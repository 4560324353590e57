/// The fold of one hinge as a rotation, in the coordinates (kappa, eta), with its first two derivatives.
///
/// With gamma = 0 and tau = kappa eta the rotation vector between neighbouring frames is h kappa (0, 1, eta):
/// a turn by h kappa sqrt(1 + eta^2) about the ruling, where h is the hinge length. No constraint is left.
/// @eq Shen2015:14 @eq Shen2015:15 (solved for, not enforced)
#pragma once

#include <cmath>

#include "wunderlich/base/types.hpp"
#include "wunderlich/math/sine.hpp"

namespace wunderlich::geometry {

/// Half-angle form of the fold; cheap to compute once and to differentiate.
struct Fold {
  double s2 = 1;        ///< 1 + eta^2
  double s = 1;         ///< |ruling|
  double inverse = 1;   ///< 1 / |ruling|
  double half_sin = 0;  ///< sin and cos of half the fold angle h kappa s
  double half_cos = 1;
};

inline Fold make_fold(double hinge_length, double kappa, double eta) {
  Fold fold;
  fold.s2 = 1 + eta * eta;
  fold.s = std::sqrt(fold.s2);
  fold.inverse = 1 / fold.s;
  const auto [sine, cosine] = math::sine_cosine(0.5 * hinge_length * kappa * fold.s);
  fold.half_sin = sine;
  fold.half_cos = cosine;
  return fold;
}

/// frame of the next segment = frame * fold_rotation
inline Quat fold_rotation(const Fold& fold, double eta) {
  const double f = fold.half_sin * fold.inverse;
  return Quat(fold.half_cos, 0, f, f * eta);
}

/// First derivatives of the rotation (left increments) and the symmetric second ones, in the parent's axes.
struct FoldDerivatives {
  Vec3 kappa, eta;          ///< theta = kappa_axis dkappa + eta_axis deta + ...
  Vec3 kappa_eta, eta_eta;  ///< ... + kappa_eta dkappa deta + eta_eta deta^2 / 2
};

inline FoldDerivatives fold_derivatives(const Fold& fold, double h, double kappa, double eta) {
  const double sine = 2 * fold.half_sin * fold.half_cos;
  const double versine = 2 * fold.half_sin * fold.half_sin;  // 1 - cos
  const double cosine = 1 - versine;
  const double i1 = fold.inverse, i2 = i1 * i1, hk = h * kappa;
  const double a = hk * eta * i2, b = sine * i1 * i2, c = versine * i2;
  FoldDerivatives d;
  d.kappa = {0, h, h * eta};
  d.eta = {c, a - b * eta, a * eta + b};
  const double ak = h * eta * i2, bk = h * cosine * i2, ck = h * sine * i1;
  d.kappa_eta = {0.5 * ck, 0.5 * (ak - bk * eta), 0.5 * (h + ak * eta + bk)};
  const double turn_eta = hk * eta * i1;  // d(angle)/d(eta)
  const double ae = hk * (1 - eta * eta) * i2 * i2;
  const double be = (cosine * turn_eta * i1 - 3 * sine * eta * i1 * i2) * i2;
  const double ce = (sine * turn_eta - 2 * versine * eta * i2) * i2;
  d.eta_eta = {ce, ae - be * eta - b, ae * eta + a + be};
  return d;
}

}  // namespace wunderlich::geometry
