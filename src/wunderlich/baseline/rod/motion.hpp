/// A rod at rest and in motion: equilibria along the motion of its supports, and implicit Euler steps.
#pragma once

#include "wunderlich/baseline/rod/newton.hpp"

namespace wunderlich::baseline::rod {

/// Equilibrium at `time` (a load parameter) from one at `state.time`: a minimum of the energy, or under loads that have
/// no potential a balance of forces. The state changes only if it converges.
Report equilibrium(const Rod& rod, const constraint::Surroundings& surroundings, double time, const Options& options,
                   State& state, Workspace& work);

/// Rates at which velocity decays [1/s], along the tangent and across it.
struct Damping {
  double tangent = 0, normal = 0;
};

/// One step of implicit Euler to `time`: an equilibrium in which masses, and inertia of turning about the tangent, tie
/// the rod to where it was going.   @eq Bergou2010, Martin2011
Report step(const Rod& rod, const constraint::Surroundings& surroundings, const Damping& damping, double time,
            const Options& options, State& state, Workspace& work);

/// What is out of balance at a state at rest under the surroundings of its time: largest net force on a node, or moment
/// on the turn of an edge over the width, of those that may move [N].
double net_force(const Rod& rod, const constraint::Surroundings& surroundings, const State& state, Workspace& work);

/// [J]
double kinetic_energy(const Rod& rod, const State& state);
double gravity_energy(const Rod& rod, const Vec3& gravity, const State& state);

}  // namespace wunderlich::baseline::rod
