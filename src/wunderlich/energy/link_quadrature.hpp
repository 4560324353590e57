/// How bending^2 is summed along one link: the one discrete elastic energy of the program, whatever the coordinates.
#pragma once

#include "wunderlich/base/types.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/ribbon.hpp"

namespace wunderlich::energy {

/// The trapezoid rule on bending^2 = (kappa (1 + eta^2))^2, corrected by a share of the midpoint rule and by a term in
/// the change of eta. Both corrections are O(l^2); the plain rule (share and term zero) has the same order but three
/// to thirty times the error (docs/decisions/0014).
struct LinkQuadrature {
  double midpoint = 0;  ///< share of (kappa_m (1 + eta_m^2))^2, m the mean of the two ends
  double ruling = 0;    ///< times -kappa_m^2 (eta_b - eta_a)^2
};
inline constexpr LinkQuadrature kPlainQuadrature{};
inline constexpr LinkQuadrature kCorrectedQuadrature{0.1, 0.27};

/// The correction supposes a full hinge at both ends of the link; the printed measure keeps the printed sum.
inline const LinkQuadrature& quadrature(const geometry::Ribbon& ribbon, const Model& model, std::size_t link) {
  const bool at_end = link == 0 || link + 1 == ribbon.rest_length.size();
  const bool plain = model.strain == StrainMeasure::printed || (at_end && !ribbon.is_loop());
  return plain ? kPlainQuadrature : kCorrectedQuadrature;
}

/// A function of (kappa, eta) at the two ends of a link, with gradient and Hessian.
struct LinkEnergy {
  double value = 0;
  Vec2 grad_a, grad_b;
  Mat2 hess_aa, hess_ab, hess_bb;
};

/// The two terms beside the trapezoids, `weight` times as much.
inline double correction_value(const LinkQuadrature& rule, double weight, const Vec2& a, const Vec2& b) {
  const double km = 0.5 * (a[0] + b[0]), em = 0.5 * (a[1] + b[1]), jump = b[1] - a[1];
  const double gm = km * (1 + em * em);
  return weight * (rule.midpoint * gm * gm - rule.ruling * km * km * jump * jump);
}

/// The same with derivatives in a = (kappa_a, eta_a) and b.
inline LinkEnergy correction(const LinkQuadrature& rule, double weight, const Vec2& a, const Vec2& b) {
  const double km = 0.5 * (a[0] + b[0]), em = 0.5 * (a[1] + b[1]), jump = b[1] - a[1];
  const double wp = weight * rule.midpoint, wc = weight * rule.ruling;
  const double g_kappa = 1 + em * em, g = km * g_kappa, g_eta = 2 * km * em;
  const double slope_kappa = wp * g * g_kappa - wc * km * jump * jump, slope_eta = wp * g * g_eta;
  const double turn = 2 * wc * km * km * jump, cross = 2 * wc * km * jump, stiff = 2 * wc * km * km;
  const double kk = 0.5 * (wp * g_kappa * g_kappa - wc * jump * jump);
  const double ke = 0.5 * wp * (g_kappa * g_eta + 2 * g * em), ee = 0.5 * wp * (g_eta * g_eta + 2 * g * km);
  LinkEnergy e;
  e.value = wp * g * g - wc * km * km * jump * jump;
  e.grad_a = {slope_kappa, slope_eta + turn};
  e.grad_b = {slope_kappa, slope_eta - turn};
  e.hess_aa << kk, ke + cross, ke + cross, ee - stiff;
  e.hess_bb << kk, ke - cross, ke - cross, ee - stiff;
  e.hess_ab << kk, ke - cross, ke + cross, ee + stiff;
  return e;
}

}  // namespace wunderlich::energy
