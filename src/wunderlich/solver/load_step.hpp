/// The minimisation problem of one load step: supports and loads of the surroundings at one load parameter.
#pragma once

#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::solver {

/// Supports at load parameter t as base conditions, holds and loads; ties are left as they are. Moves the base of
/// `chain` to its prescribed pose where it has one. Allocates nothing once `problem` has its size.
void problem_at(const PathProblem& path, const PathState& state, double t, geometry::Chain& chain,
                ChainProblem& problem);

/// The link whose pose a support holds; the number of segments for the end node's own frame.
int held_link(const constraint::Support& support);

/// Is it the start node's own frame that the support holds, the one before the first hinge?
bool holds_base_frame(const geometry::Ribbon& ribbon, const constraint::Support& support);

/// Is the start node's pose prescribed, so that it is the base of the chain.
bool base_is_held(const PathProblem& path);

/// Way that the busiest support makes between two load parameters: turns [rad] and displacements / length, summed.
double motion_between(const PathProblem& path, double t0, double t1);

}  // namespace wunderlich::solver
