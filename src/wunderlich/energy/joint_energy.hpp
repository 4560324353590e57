/// The elastic energy in joint coordinates: the bending of each hinge, coupled along a link by the width
/// factor of its ruling ratio. tau = kappa eta is already inserted.
#pragma once

#include <limits>

#include "wunderlich/base/types.hpp"
#include "wunderlich/energy/link_quadrature.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/energy/width_factor.hpp"
#include "wunderlich/geometry/joint.hpp"

namespace wunderlich::energy {

/// Bending of one hinge with its derivatives in (kappa, eta).
template <class Real>
struct Bending {
  Real value, kappa, eta, kappa_eta, eta_eta, kappa_kappa;
};

/// kappa (1 + eta^2): the principal curvature at the centerline, signed [1/m]; with the printed strain measure the
/// same of its (2/h) sin(angle/2). @eq Shen2015:11 (erratum: E = kappa^2 + 2 tau^2 + tau^2 eta^2 = bending^2)
template <class Real>
inline Bending<Real> bending(StrainMeasure measure, Real h, Real kappa, Real eta, const geometry::Fold<Real>& fold) {
  if (measure == StrainMeasure::logarithm) {
    return {kappa * fold.s2, fold.s2, 2 * kappa * eta, 2 * eta, 2 * kappa, 0 * kappa};
  }
  // (2/h) sin(a/2) s with a = h kappa s, s = sqrt(1 + eta^2); where there is no hinge, 2/h is only to be finite.
  const Real s = fold.s, sine = fold.half_sin, cosine = fold.half_cos, i = eta * fold.inverse;
  const Real c = 2 / (h + std::numeric_limits<double>::min());
  const Real half_eta = 0.5 * h * kappa * i;  // d(a/2)/d(eta)
  Bending<Real> b;
  b.value = c * sine * s;
  b.kappa = cosine * fold.s2;
  b.eta = c * (cosine * half_eta * s + sine * i);
  b.kappa_kappa = -0.5 * h * sine * s * fold.s2;
  b.kappa_eta = 2 * eta * cosine - sine * half_eta * fold.s2;
  b.eta_eta = c * (-sine * half_eta * half_eta * s + 2 * cosine * half_eta * i +
                   (cosine * 0.5 * h * kappa + sine * fold.inverse) / fold.s2);
  return b;
}

/// One end of a link. Where there is no hinge kappa is 0, and so are bending and its slope in eta.
template <class Real>
struct LinkEnd {
  JointPair<Real> at;
  Bending<Real> bending;
};

/// Value of the quadrature without derivatives, for line searches; `weight` is D w length / 2.
template <class Real>
inline Real link_bending(const LinkQuadrature<Real>& rule, Real weight, const LinkEnd<Real>& a,
                         const LinkEnd<Real>& b) {
  const Real ga = a.bending.value, gb = b.bending.value;
  return 0.5 * (1 - rule.midpoint) * weight * (ga * ga + gb * gb) + correction_value(rule, weight, a.at, b.at);
}

namespace detail {

/// Adds weight/2 bending^2 of one end.
template <class Real>
inline void add_end(Real weight, const Bending<Real>& g, Real& value, JointPair<Real>& grad, JointSquare<Real>& hess) {
  const Real f = weight * g.value;
  value += 0.5 * f * g.value;
  grad.kappa += f * g.kappa;
  grad.eta += f * g.eta;
  hess.kappa_kappa += weight * g.kappa * g.kappa + f * g.kappa_kappa;
  hess.kappa_eta += weight * g.kappa * g.eta + f * g.kappa_eta;
  hess.eta_eta += weight * g.eta * g.eta + f * g.eta_eta;
}

/// Multiplies a block of the Hessian by `factor`, then adds to its second row and column what `add_...` say.
template <class Real>
inline JointSquare<Real> scaled(const JointSquare<Real>& hess, Real factor, Real add_kappa_eta, Real add_eta_eta) {
  return {factor * hess.kappa_kappa, factor * hess.kappa_eta + add_kappa_eta, factor * hess.eta_eta + add_eta_eta};
}

}  // namespace detail

/// phi(x) link_bending + barrier(x), x = k (eta_b - eta_a). @eq Shen2015:3 (on segments)
template <class Real>
inline LinkEnergy<Real> link_energy(const WidthFactor<Real>& phi, const WidthFactor<Real>& barrier, Real k,
                                    const LinkQuadrature<Real>& rule, Real weight, const LinkEnd<Real>& a,
                                    const LinkEnd<Real>& b) {
  LinkEnergy<Real> e = correction(rule, weight, a.at, b.at);
  const Real end_weight = (1 - rule.midpoint) * weight;
  detail::add_end(end_weight, a.bending, e.value, e.grad_a, e.hess_aa);
  detail::add_end(end_weight, b.bending, e.value, e.grad_b, e.hess_bb);
  const Real slope = k * (phi.first * e.value + barrier.first);
  const Real bend = k * k * (phi.second * e.value + barrier.second);
  const Real m = k * phi.first;
  const JointPair<Real> ma{m * e.grad_a.kappa, m * e.grad_a.eta}, mb{m * e.grad_b.kappa, m * e.grad_b.eta};
  e.hess_aa = detail::scaled<Real>(e.hess_aa, phi.value, -ma.kappa, bend - 2 * ma.eta);
  e.hess_bb = detail::scaled<Real>(e.hess_bb, phi.value, mb.kappa, bend + 2 * mb.eta);
  e.hess_ab = {phi.value * e.hess_ab.kappa_kappa, phi.value * e.hess_ab.kappa_eta + ma.kappa,
               phi.value * e.hess_ab.eta_kappa - mb.kappa, phi.value * e.hess_ab.eta_eta + ma.eta - mb.eta - bend};
  e.grad_a = {phi.value * e.grad_a.kappa, phi.value * e.grad_a.eta - slope};
  e.grad_b = {phi.value * e.grad_b.kappa, phi.value * e.grad_b.eta + slope};
  e.value = phi.value * e.value + barrier.value;
  return e;
}

}  // namespace wunderlich::energy
