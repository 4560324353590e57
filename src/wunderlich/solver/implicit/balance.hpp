/// The energy balance of a step.
#pragma once

#include "wunderlich/solver/implicit/implicit.hpp"

namespace wunderlich::solver::implicit {

/// Work that dead loads, supports and moving solids do in the step under way [J]: by the forces before and after with
/// the weights that the scheme itself gives to forces at either end.
double work_done(Paths paths, const Scheme& scheme, const State& state, const Workspace& work);

/// Corrects the velocities of the step under way so that the energy has not grown by `growth`. Of one strip alone.
void keep_conserved(const geometry::Ribbon& ribbon, const Options& options, double growth, State& state,
                    Workspace& work);

}  // namespace wunderlich::solver::implicit
