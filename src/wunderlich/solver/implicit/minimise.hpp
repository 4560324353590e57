/// Newton's method of a step in time, on all strips of a scene at once.
///
/// Masses tie the strips to where they were going: terms that carry forces are left out where they would make the
/// Hessian indefinite, a step below the tolerance is taken and the last one, and whether it ends in a minimum or a
/// saddle is not asked. Strips that do not feel one another are swept each by itself.
#pragma once

#include <span>

#include "wunderlich/solver/newton.hpp"

namespace wunderlich::solver::implicit {

/// One strip, from its prediction to where the step takes it.
struct MovingStrip {
  const geometry::Ribbon* ribbon;
  const ChainProblem* problem;
  geometry::Chain* chain;            ///< changed only if the method converges
  std::vector<double>* multipliers;  ///< one a row; changed as well
  const ContactPoints* before;       ///< what it touches where the step begins
};

/// Buffers; no allocation once they have their size. After a solve they hold what belongs to its end.
struct MinimiseWorkspace {
  std::vector<NewtonWorkspace> strips;
  SelfContacts self, trial_self;
  SelfSearch search;
  bool placed = false;                           ///< are the iterates in place? Taken once
  std::vector<StripPlace> places, trial_places;  ///< `current` and `trial` of the strips
  std::vector<math::ChainPart> parts;
  std::vector<math::ChainSystem*> systems;
  std::vector<math::ChainCoupling> between;
};

/// Puts the iterates where the chains are, on their way from where the step begins (`before`: what they touch of
/// themselves and one another there). False if something is in the way; otherwise Newton's method starts there.
bool place(std::span<const MovingStrip> strips, const SelfContact& self, const SelfContacts& before,
           MinimiseWorkspace& work);

/// Finds the minimum near the chains.
NewtonReport minimise(std::span<const MovingStrip> strips, const SelfContact& self, const NewtonOptions& options,
                      MinimiseWorkspace& work);

}  // namespace wunderlich::solver::implicit
