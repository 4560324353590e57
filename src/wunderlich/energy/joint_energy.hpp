/// The elastic energy in joint coordinates: the bending of each hinge, coupled along a link by the width
/// factor of its ruling ratio. tau = kappa eta is already inserted.
#pragma once

#include "wunderlich/base/types.hpp"
#include "wunderlich/energy/link_quadrature.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/energy/width_factor.hpp"
#include "wunderlich/geometry/joint.hpp"

namespace wunderlich::energy {

/// Bending of one hinge with its derivatives in (kappa, eta).
struct Bending {
  double value = 0, kappa = 0, eta = 0, kappa_eta = 0, eta_eta = 0, kappa_kappa = 0;
};

/// kappa (1 + eta^2): the principal curvature at the centerline, signed [1/m]; with the printed strain measure the
/// same of its (2/h) sin(angle/2). @eq Shen2015:11 (erratum: E = kappa^2 + 2 tau^2 + tau^2 eta^2 = bending^2)
inline Bending bending(StrainMeasure measure, double h, double kappa, double eta, const geometry::Fold& fold) {
  if (measure == StrainMeasure::logarithm) return {kappa * fold.s2, fold.s2, 2 * kappa * eta, 2 * eta, 2 * kappa, 0};
  if (h == 0) return {};
  // (2/h) sin(a/2) s with a = h kappa s, s = sqrt(1 + eta^2)
  const double s = fold.s, sine = fold.half_sin, cosine = fold.half_cos, i = eta / s, c = 2 / h;
  const double half_eta = 0.5 * h * kappa * i;  // d(a/2)/d(eta)
  Bending b;
  b.value = c * sine * s;
  b.kappa = cosine * fold.s2;
  b.eta = c * (cosine * half_eta * s + sine * i);
  b.kappa_kappa = -0.5 * h * sine * s * fold.s2;
  b.kappa_eta = 2 * eta * cosine - sine * half_eta * fold.s2;
  b.eta_eta = c * (-sine * half_eta * half_eta * s + 2 * cosine * half_eta * i +
                   (cosine * 0.5 * h * kappa + sine / s) / fold.s2);
  return b;
}

/// Joint coordinates at one end of a link, and D w times the length of that hinge that lies in the link.
struct LinkEnd {
  double kappa, eta;
  Bending bending;
  double weight;
};

/// Value of the quadrature (times D w length / 2) without derivatives, for line searches.
inline double link_bending(const LinkQuadrature& rule, const LinkEnd& a, const LinkEnd& b) {
  const double ga = a.bending.value, gb = b.bending.value;
  const double ends = 0.5 * (1 - rule.midpoint) * (a.weight * ga * ga + b.weight * gb * gb);
  if (rule.midpoint == 0) return ends;
  return ends + correction_value(rule, 0.5 * (a.weight + b.weight), {a.kappa, a.eta}, {b.kappa, b.eta});
}

namespace detail {

/// link_bending with derivatives: gradient and Hessian in (kappa_a, eta_a), (kappa_b, eta_b).
inline LinkEnergy bending_terms(const LinkQuadrature& rule, const LinkEnd& a, const LinkEnd& b) {
  LinkEnergy e;
  if (rule.midpoint == 0) {
    e.grad_a.setZero();
    e.grad_b.setZero();
    e.hess_aa.setZero();
    e.hess_ab.setZero();
    e.hess_bb.setZero();
  } else {
    e = correction(rule, 0.5 * (a.weight + b.weight), {a.kappa, a.eta}, {b.kappa, b.eta});
  }
  const auto end = [&](const LinkEnd& at, Vec2& grad, Mat2& hess) {
    const Bending& g = at.bending;
    const double w = (1 - rule.midpoint) * at.weight, f = w * g.value;
    e.value += 0.5 * f * g.value;
    grad += Vec2(f * g.kappa, f * g.eta);
    const double mixed = w * g.kappa * g.eta + f * g.kappa_eta;
    hess(0, 0) += w * g.kappa * g.kappa + f * g.kappa_kappa;
    hess(0, 1) += mixed;
    hess(1, 0) += mixed;
    hess(1, 1) += w * g.eta * g.eta + f * g.eta_eta;
  };
  end(a, e.grad_a, e.hess_aa);
  end(b, e.grad_b, e.hess_bb);
  return e;
}

}  // namespace detail

/// phi(x) link_bending + barrier(x), x = k (eta_b - eta_a). @eq Shen2015:3 (on segments)
inline LinkEnergy link_energy(const WidthFactor& phi, const WidthFactor& barrier, double k, const LinkQuadrature& rule,
                              const LinkEnd& a, const LinkEnd& b) {
  LinkEnergy e = detail::bending_terms(rule, a, b);
  const double slope = k * (phi.first * e.value + barrier.first);
  const double bend = k * k * (phi.second * e.value + barrier.second);
  const Vec2 ma = k * phi.first * e.grad_a, mb = k * phi.first * e.grad_b;
  e.value = phi.value * e.value + barrier.value;
  e.hess_aa *= phi.value;
  e.hess_ab *= phi.value;
  e.hess_bb *= phi.value;
  e.hess_aa(0, 1) -= ma[0];
  e.hess_aa(1, 0) -= ma[0];
  e.hess_aa(1, 1) += bend - 2 * ma[1];
  e.hess_bb(0, 1) += mb[0];
  e.hess_bb(1, 0) += mb[0];
  e.hess_bb(1, 1) += bend + 2 * mb[1];
  e.hess_ab(0, 1) += ma[0];
  e.hess_ab(1, 0) -= mb[0];
  e.hess_ab(1, 1) += ma[1] - mb[1] - bend;
  e.grad_a *= phi.value;
  e.grad_b *= phi.value;
  e.grad_a[1] -= slope;
  e.grad_b[1] += slope;
  return e;
}

}  // namespace wunderlich::energy
