/// Energies of position and velocity of the centerline: gravity and motion.
#pragma once

#include "wunderlich/geometry/chart.hpp"

namespace wunderlich::energy {

/// -sum m_i g . r_i with the masses lumped at the nodes; 0 for a strip through the origin [J].
double gravity_value(const geometry::Ribbon& ribbon, const Vec3& gravity, const geometry::State& state);
/// Adds its gradient. The Hessian is 0.
void add_gravity_gradient(const geometry::Ribbon& ribbon, const Vec3& gravity, Eigen::VectorXd& gradient);

/// The paper's kinetic energy, that of the centerline alone, with lumped masses [J].   @eq Shen2015:6
double kinetic_value(const geometry::Ribbon& ribbon, const geometry::State& state);

}  // namespace wunderlich::energy
