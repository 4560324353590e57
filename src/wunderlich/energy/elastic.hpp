/// Elastic energy of the ribbon in the paper's coordinates, off the constraints as well as on them.
///
/// V = sum over segments of (D w l/4) phi(x) ((1 - m)(E_a + E_b) + 2 m G^2 - 2 c kappa_m^2 (eta_b - eta_a)^2),
///   E = kappa^2 + 2 tau^2 + tau^2 eta^2,   G = kappa_m (1 + eta_m^2),
/// with a and b the hinges at the two ends of the segment, x its ruling ratio, kappa_m and eta_m means of the two ends,
/// and the shares m and c of energy/link_quadrature.hpp. So each segment holds half a cell of the hinge at either end;
/// a free end has no hinge and E = 0, and segment 0 of a loop sees the seam's hinge from the other side. Where
/// kappa eta = tau, E is kappa^2 (1 + eta^2)^2, and this is the energy of joint_energy.hpp.
/// @eq Shen2015:11
#pragma once

#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/chart.hpp"

namespace wunderlich::energy {

using geometry::Triplets;

/// [J]; infinite where the exact energy is (|x| >= 1).
double elastic_value(const geometry::Ribbon& ribbon, const Model& model, const geometry::State& state);

/// Adds dV/dx to a vector of size chart_size.
void add_elastic_gradient(const geometry::Ribbon& ribbon, const Model& model, const geometry::State& state,
                          Eigen::VectorXd& gradient);

/// Adds d2V/dx2.
void add_elastic_hessian(const geometry::Ribbon& ribbon, const Model& model, const geometry::State& state,
                         Triplets& hessian);

/// e1 D sum over segments of (l/w) (-ln(1 - x^2)): the barrier that keeps |x| < 1 where curvature vanishes.
/// @eq Shen2015:13
double barrier_value(const geometry::Ribbon& ribbon, double e1, const geometry::State& state);
void add_barrier_gradient(const geometry::Ribbon& ribbon, double e1, const geometry::State& state,
                          Eigen::VectorXd& gradient);
void add_barrier_hessian(const geometry::Ribbon& ribbon, double e1, const geometry::State& state, Triplets& hessian);

}  // namespace wunderlich::energy
