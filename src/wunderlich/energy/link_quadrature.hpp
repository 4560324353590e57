/// How bending^2 is summed along one link: the one discrete elastic energy of the program, whatever the coordinates.
#pragma once

#include "wunderlich/base/types.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/math/four.hpp"

namespace wunderlich::energy {

/// The trapezoid rule on bending^2 = (kappa (1 + eta^2))^2, corrected by a share of the midpoint rule and by a term in
/// the change of eta. Both corrections are O(l^2); the plain rule (share and term zero) has the same order but three
/// to thirty times the error (docs/decisions/0014).
template <class Real>
struct LinkQuadrature {
  Real midpoint;  ///< share of (kappa_m (1 + eta_m^2))^2, m the mean of the two ends
  Real ruling;    ///< times -kappa_m^2 (eta_b - eta_a)^2
};
inline constexpr LinkQuadrature<double> kPlainQuadrature{0, 0};
inline constexpr LinkQuadrature<double> kCorrectedQuadrature{0.1, 0.27};

/// The correction supposes a full hinge at both ends of the link; the printed measure keeps the printed sum.
inline const LinkQuadrature<double>& quadrature(const geometry::Ribbon& ribbon, const Model& model, std::size_t link) {
  const bool at_end = link == 0 || link + 1 == ribbon.rest_length.size();
  const bool plain = model.strain == StrainMeasure::printed || (at_end && !ribbon.is_loop());
  return plain ? kPlainQuadrature : kCorrectedQuadrature;
}

/// The same for four links; what it says of links beyond the last means nothing.
inline LinkQuadrature<math::Four> four_quadratures(const geometry::Ribbon& ribbon, const Model& model,
                                                   std::size_t first) {
  const auto rule = [&](std::size_t k) -> const LinkQuadrature<double>& {
    return quadrature(ribbon, model, first + k);
  };
  const LinkQuadrature<double>&a = rule(0), &b = rule(1), &c = rule(2), &d = rule(3);
  return {math::Four{a.midpoint, b.midpoint, c.midpoint, d.midpoint},
          math::Four{a.ruling, b.ruling, c.ruling, d.ruling}};
}

/// Joint coordinates at one end of a link, or a gradient in them.
template <class Real>
struct JointPair {
  Real kappa, eta;
};

/// Second derivatives at one end, and across a link (row: end a, column: end b).
template <class Real>
struct JointSquare {
  Real kappa_kappa, kappa_eta, eta_eta;
};
template <class Real>
struct JointCross {
  Real kappa_kappa, kappa_eta, eta_kappa, eta_eta;
};

/// A function of (kappa, eta) at the two ends of a link, with gradient and Hessian.
template <class Real>
struct LinkEnergy {
  Real value;
  JointPair<Real> grad_a, grad_b;
  JointSquare<Real> hess_aa, hess_bb;
  JointCross<Real> hess_ab;
};

/// The two terms beside the trapezoids, `weight` times as much.
template <class Real>
inline Real correction_value(const LinkQuadrature<Real>& rule, Real weight, const JointPair<Real>& a,
                             const JointPair<Real>& b) {
  const Real km = 0.5 * (a.kappa + b.kappa), em = 0.5 * (a.eta + b.eta), jump = b.eta - a.eta;
  const Real gm = km * (1 + em * em);
  return weight * (rule.midpoint * gm * gm - rule.ruling * km * km * jump * jump);
}

/// The same with derivatives.
template <class Real>
inline LinkEnergy<Real> correction(const LinkQuadrature<Real>& rule, Real weight, const JointPair<Real>& a,
                                   const JointPair<Real>& b) {
  const Real km = 0.5 * (a.kappa + b.kappa), em = 0.5 * (a.eta + b.eta), jump = b.eta - a.eta;
  const Real wp = weight * rule.midpoint, wc = weight * rule.ruling;
  const Real g_kappa = 1 + em * em, g = km * g_kappa, g_eta = 2 * km * em;
  const Real slope_kappa = wp * g * g_kappa - wc * km * jump * jump, slope_eta = wp * g * g_eta;
  const Real turn = 2 * wc * km * km * jump, cross = 2 * wc * km * jump, stiff = 2 * wc * km * km;
  const Real kk = 0.5 * (wp * g_kappa * g_kappa - wc * jump * jump);
  const Real ke = 0.5 * wp * (g_kappa * g_eta + 2 * g * em), ee = 0.5 * wp * (g_eta * g_eta + 2 * g * km);
  LinkEnergy<Real> e;
  e.value = wp * g * g - wc * km * km * jump * jump;
  e.grad_a = {slope_kappa, slope_eta + turn};
  e.grad_b = {slope_kappa, slope_eta - turn};
  e.hess_aa = {kk, ke + cross, ee - stiff};
  e.hess_bb = {kk, ke - cross, ee - stiff};
  e.hess_ab = {kk, ke - cross, ke + cross, ee + stiff};
  return e;
}

}  // namespace wunderlich::energy
