/// Stage ode: the centerline moves under the pull of the frames, loads and gravity, then lengths are restored.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Symplectic Euler, fast projection of lengths and pins, damping; moves `shape.r` and `shape.r_dot`. False and a
/// reason in the report if lengths cannot be restored.   @eq Shen2015:20
bool advance_centerline(const geometry::Ribbon& ribbon, const Drive& drive, const OdeOptions& options, double dt,
                        geometry::State& shape, Workspace& work, StepReport& report);

/// Restores the lengths of `shape.r` by mass-weighted Newton corrections along e (fast projection). Returns the
/// iterations used, or -1 if the tolerance was not reached.   @eq Shen2015:12
int project_lengths(const geometry::Ribbon& ribbon, const OdeOptions& options, geometry::State& shape, Workspace& work);

/// Damping of `shape.r_dot` along and across the centerline, as it is applied once a step.
void damp(const geometry::Ribbon& ribbon, const OdeOptions& options, double dt, geometry::State& shape);

}  // namespace wunderlich::solver::two_stage
