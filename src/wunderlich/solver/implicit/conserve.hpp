/// Conservation by correction: after a step the velocities are changed as little as it takes to have the energy, and on
/// a strip that nothing acts on the momenta, that the motion must have.   @eq Hairer2006:IV.4
#pragma once

#include "wunderlich/solver/implicit/inertia.hpp"

namespace wunderlich::solver::implicit {

/// What is to be kept.
struct Conserved {
  double kinetic = 0;                  ///< the kinetic energy that makes the sum right [J]
  const Momentum* momentum = nullptr;  ///< of a strip on which nothing acts; null otherwise
};

/// Buffers; no allocation once they have their size.
struct ConserveWorkspace {
  std::vector<std::size_t> held;  ///< input: points that supports move, whose velocities are not to be touched
  Points kept, rest;              ///< the part of the motion that stays, and what is scaled
};

/// Corrects the velocities. With momenta: first the rigid motion that is missing, then the rest of the velocity is
/// scaled; without: all of it but that of held points. Where nearly all of the energy is elastic a factor could be
/// anything: it is bounded, and what is missing is returned for the next step [J].
double conserve(const geometry::Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta,
                const Conserved& wanted, ConserveWorkspace& work, Points& points);

}  // namespace wunderlich::solver::implicit
