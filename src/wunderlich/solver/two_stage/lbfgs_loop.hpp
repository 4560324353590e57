/// The paper's stage opt: one L-BFGS step without constraints, the projection of Eq. 22, corrections, and again.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Iterates until the gradient changes by less than the share of the options and the constraints hold, or to the cap.
/// False and a reason in the report where it cannot go on.   @eq Shen2015:21
bool minimise_lbfgs(const geometry::Ribbon& ribbon, const Options& options, geometry::State& shape, Workspace& work,
                    StepReport& report);

}  // namespace wunderlich::solver::two_stage
