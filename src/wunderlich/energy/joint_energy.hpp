/// The elastic energy in joint coordinates: the bending of each hinge, coupled along a link by the width
/// factor of its ruling ratio. tau = kappa eta is already inserted.
#pragma once

#include "wunderlich/base/types.hpp"
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
  const double half_eta = 0.5 * h * kappa * i;                     // d(a/2)/d(eta)
  Bending b;
  b.value = c * sine * s;
  b.kappa = cosine * fold.s2;
  b.eta = c * (cosine * half_eta * s + sine * i);
  b.kappa_kappa = -0.5 * h * sine * s * fold.s2;
  b.kappa_eta = 2 * eta * cosine - sine * half_eta * fold.s2;
  b.eta_eta = c * (-sine * half_eta * half_eta * s + 2 * cosine * half_eta * i + (cosine * 0.5 * h * kappa + sine / s) / fold.s2);
  return b;
}

/// Energy of one link in (kappa, eta) of its two nodes.
struct LinkEnergy {
  double value = 0;
  Vec2 grad_a, grad_b;
  Mat2 hess_aa, hess_ab, hess_bb;
};

/// phi(x) (weight_a bending_a^2 + weight_b bending_b^2)/2 + barrier(x), x = k (eta_b - eta_a).
/// The weights are D w times the share of each hinge's length that lies in the link. @eq Shen2015:3 (on segments)
inline LinkEnergy link_energy(const WidthFactor& phi, const WidthFactor& barrier, double k, double weight_a,
                              const Bending& a, double weight_b, const Bending& b) {
  const double mean = 0.5 * (weight_a * a.value * a.value + weight_b * b.value * b.value);
  const double slope = k * (phi.first * mean + barrier.first);
  const double bend = k * k * (phi.second * mean + barrier.second);
  const double fa = weight_a * a.value, fb = weight_b * b.value;   // d(mean)/d(bending)
  const double pa = phi.value * fa, pb = phi.value * fb, wa = phi.value * weight_a, wb = phi.value * weight_b;
  const double ma = k * phi.first * fa, mb = k * phi.first * fb;
  LinkEnergy e;
  e.value = phi.value * mean + barrier.value;
  e.grad_a = {pa * a.kappa, pa * a.eta - slope};
  e.grad_b = {pb * b.kappa, pb * b.eta + slope};
  const double ake = wa * a.kappa * a.eta + pa * a.kappa_eta - ma * a.kappa;
  const double bke = wb * b.kappa * b.eta + pb * b.kappa_eta + mb * b.kappa;
  e.hess_aa << wa * a.kappa * a.kappa + pa * a.kappa_kappa, ake, ake,
      wa * a.eta * a.eta + pa * a.eta_eta - 2 * ma * a.eta + bend;
  e.hess_bb << wb * b.kappa * b.kappa + pb * b.kappa_kappa, bke, bke,
      wb * b.eta * b.eta + pb * b.eta_eta + 2 * mb * b.eta + bend;
  e.hess_ab << 0, ma * a.kappa, -mb * b.kappa, ma * a.eta - mb * b.eta - bend;
  return e;
}

}  // namespace wunderlich::energy
