/// Stage contact: after ode and opt, the nearest (r, q, eta) that no solid cuts, with friction.   @eq Shen2015:6.3
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Keeps the strip out of the drive's solids at the end of a substep of length dt [s] that work.before began. What the
/// linearisation leaves is found and projected again. Nothing happens where nothing touches.
bool settle_contact(const geometry::Ribbon& ribbon, const Drive& drive, const Options& options, double dt, State& state,
                    Workspace& work, StepReport& report);

}  // namespace wunderlich::solver::two_stage
