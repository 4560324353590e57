/// The paper's Algorithm 1: one explicit step of the centerline (stage ode), then frames and rulings brought to rest
/// under it (stage opt).
///
/// The default is the repaired scheme; `printed_options` is the scheme as printed. docs/two-stage.md says what was
/// repaired and why.   @eq Shen2015:alg1
#pragma once

#include "wunderlich/solver/two_stage/types.hpp"
#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// At rest, with spin and multipliers zero.
State start(const geometry::Ribbon& ribbon, const geometry::State& shape);

/// Longest stable step of stage ode [s]: 2/omega with omega^2 the largest eigenvalue of M^-1 d2 E_para/dr2 (Gershgorin,
/// exact for equal segments). `parallel_weight` in [J].
double stable_step(const geometry::Ribbon& ribbon, double parallel_weight);

/// w_para of the flat strip [J].
double rest_parallel_weight(const geometry::Ribbon& ribbon, double weight_scale);

/// One step of length dt [s] under a drive. A step that fails leaves the state untouched and says why.
StepReport step(const geometry::Ribbon& ribbon, const Drive& drive, const Options& options, double dt, State& state,
                Workspace& work);

}  // namespace wunderlich::solver::two_stage
