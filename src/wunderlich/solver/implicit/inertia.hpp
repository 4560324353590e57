/// What is inert in a strip: the points whose motion is integrated, and the springs that stand for a step of it.
#pragma once

#include "wunderlich/solver/chain_objective.hpp"
#include "wunderlich/solver/implicit/points.hpp"

namespace wunderlich::solver::implicit {

enum class KineticEnergy {
  centerline,  ///< masses on the centerline: turning about it costs nothing   @eq Shen2015:6
  rotary,      ///< and the inertia of the width, rho w^3/12 |d2'|^2 per length
  full,        ///< every facet as the plate that it is, from its material velocity   @eq Shen2015:5
};

/// Nodes (segments + 1), then, unless the kinetic energy is the centerline's, the directions d2 (segments).
std::size_t point_count(const geometry::Ribbon& ribbon, KineticEnergy kinetic);
void read_points(const geometry::Ribbon& ribbon, KineticEnergy kinetic, const geometry::Kinematics& kinematics,
                 std::vector<Vec3>& x);

/// Ties nodes and facets to the anchors of a step. `eta`: rulings (segments + 1) that facets are bounded by; they have
/// no inertia and are taken from the step's start.
void tie(const geometry::Ribbon& ribbon, KineticEnergy kinetic, const Scheme& scheme, const Points& points,
         const std::vector<double>& eta, ChainProblem& problem);

/// Of the points' velocities [J].
double kinetic_energy(const geometry::Ribbon& ribbon, KineticEnergy kinetic, const Points& points,
                      const std::vector<double>& eta);

/// Linear momentum [kg m/s] and angular momentum about the origin [kg m^2/s].
struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};
Momentum momentum(const geometry::Ribbon& ribbon, KineticEnergy kinetic, const Points& points,
                  const std::vector<double>& eta);

}  // namespace wunderlich::solver::implicit
