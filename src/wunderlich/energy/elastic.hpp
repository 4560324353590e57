/// Elastic energy of the ribbon in the paper's coordinates, off the constraints as well as on them.
///
/// V = sum over hinges of (D w/2) E (l_-/2 phi(x_-) + l_+/2 phi(x_+)),   E = kappa^2 + 2 tau^2 + tau^2 eta^2,
/// with l_-, x_- rest length and ruling ratio of the segment before the hinge, l_+, x_+ of the one after. In other
/// words each segment holds half a cell of the hinge at either end. A clamped end has the one half cell inside
/// the strip, a free end none; segment 0 of a loop holds half of the seam's hinge.
/// Where kappa eta = tau, E is kappa^2 (1 + eta^2)^2.
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
