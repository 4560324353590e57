/// Energy of one link as a function of (kappa, tau, eta) at its two ends: the terms of energy/elastic.hpp, for whoever
/// has its own way from coordinates to strains.
#pragma once

#include "wunderlich/energy/link_quadrature.hpp"
#include "wunderlich/energy/width_factor.hpp"

namespace wunderlich::energy {

/// What a link's energy depends on: (kappa, tau, eta) at either end.
using Ends = Eigen::Matrix<double, 6, 1>;
using EndsMatrix = Eigen::Matrix<double, 6, 6>;
inline constexpr int kEtaA = 2, kEtaB = 5;

/// A function of the ends with its derivatives.
struct LinkTerms {
  double value = 0;
  Ends gradient = Ends::Zero();
  EndsMatrix hessian = EndsMatrix::Zero();
};

/// Adds weight/2 E, E = kappa^2 + 2 tau^2 + tau^2 eta^2, of the end whose kappa stands at `at`.   @eq Shen2015:11
inline void add_trapezoid(double weight, const Ends& ends, int at, LinkTerms& terms) {
  const double kappa = ends[at], tau = ends[at + 1], eta = ends[at + 2], stretch = 2 + eta * eta;
  terms.value += 0.5 * weight * (kappa * kappa + tau * tau * stretch);
  terms.gradient.segment<3>(at) += weight * Vec3(kappa, tau * stretch, tau * tau * eta);
  Mat3 hessian;
  hessian << 1, 0, 0, 0, stretch, 2 * tau * eta, 0, 2 * tau * eta, tau * tau;
  terms.hessian.block<3, 3>(at, at) += weight * hessian;
}

/// The correction knows tau only as kappa eta.
inline void add_correction(const LinkQuadrature<double>& rule, double weight, const Ends& ends, LinkTerms& terms) {
  const auto e = correction<double>(rule, weight, {ends[0], ends[2]}, {ends[3], ends[5]});
  terms.value += e.value;
  Mat4 hessian;  // in (kappa_a, eta_a, kappa_b, eta_b)
  hessian << e.hess_aa.kappa_kappa, e.hess_aa.kappa_eta, e.hess_ab.kappa_kappa, e.hess_ab.kappa_eta,  //
      e.hess_aa.kappa_eta, e.hess_aa.eta_eta, e.hess_ab.eta_kappa, e.hess_ab.eta_eta,                 //
      e.hess_ab.kappa_kappa, e.hess_ab.eta_kappa, e.hess_bb.kappa_kappa, e.hess_bb.kappa_eta,         //
      e.hess_ab.kappa_eta, e.hess_ab.eta_eta, e.hess_bb.kappa_eta, e.hess_bb.eta_eta;
  const Vec4 gradient(e.grad_a.kappa, e.grad_a.eta, e.grad_b.kappa, e.grad_b.eta);
  constexpr int at[] = {0, 2, 3, 5};
  for (int i = 0; i < 4; ++i) {
    terms.gradient[at[i]] += gradient[i];
    for (int j = 0; j < 4; ++j) terms.hessian(at[i], at[j]) += hessian(i, j);
  }
}

/// Multiplies by phi(x), x = slope (eta_b - eta_a).
inline void multiply(const WidthFactor<double>& phi, double slope, LinkTerms& terms) {
  Ends x = Ends::Zero();
  x[kEtaA] = -slope;
  x[kEtaB] = slope;
  terms.hessian *= phi.value;
  terms.hessian += phi.first * (x * terms.gradient.transpose() + terms.gradient * x.transpose());
  terms.hessian += phi.second * terms.value * x * x.transpose();
  terms.gradient = (phi.value * terms.gradient + phi.first * terms.value * x).eval();
  terms.value *= phi.value;
}

/// Energy of link `s` with derivatives in its ends.
inline LinkTerms link_terms(const geometry::Ribbon& ribbon, const Model& model, std::size_t s, const Ends& ends) {
  const LinkQuadrature<double>& rule = quadrature(ribbon, model, s);
  const double weight = 0.5 * ribbon.bending_stiffness * ribbon.width * ribbon.rest_length[s];
  const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
  LinkTerms terms;
  add_trapezoid((1 - rule.midpoint) * weight, ends, 0, terms);
  add_trapezoid((1 - rule.midpoint) * weight, ends, 3, terms);
  if (rule.midpoint != 0) add_correction(rule, weight, ends, terms);
  multiply(width_factor(model, slope * (ends[kEtaB] - ends[kEtaA])), slope, terms);
  return terms;
}

/// The same without derivatives.
inline double link_value(const geometry::Ribbon& ribbon, const Model& model, std::size_t s, const Ends& ends) {
  const LinkQuadrature<double>& rule = quadrature(ribbon, model, s);
  const double weight = 0.5 * ribbon.bending_stiffness * ribbon.width * ribbon.rest_length[s];
  double sum = 0;
  for (const int at : {0, 3}) {
    const double kappa = ends[at], tau = ends[at + 1], eta = ends[at + 2];
    sum += 0.5 * (1 - rule.midpoint) * weight * (kappa * kappa + tau * tau * (2 + eta * eta));
  }
  if (rule.midpoint != 0) sum += correction_value<double>(rule, weight, {ends[0], ends[2]}, {ends[3], ends[5]});
  const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
  return width_factor(model, slope * (ends[kEtaB] - ends[kEtaA])).value * sum;
}

}  // namespace wunderlich::energy
