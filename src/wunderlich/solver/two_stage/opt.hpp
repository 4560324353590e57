/// Stage opt: frames and rulings come to rest under the centerline.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Minimises V + E_para over (q, eta) with r fixed, under the constraints, by the method of the options. False and a
/// reason in the report if the constraints were not met or the minimiser could not go on.   @eq Shen2015:21
bool settle_rulings(const geometry::Ribbon& ribbon, const Options& options, State& state, Workspace& work,
                    StepReport& report);

}  // namespace wunderlich::solver::two_stage
