/// The repaired stage opt: Newton's method on the Lagrangian of Eq. 21 and its constraints, one banded solve each.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Brings frames and rulings of `shape` to the constrained minimum under its centerline; `multipliers` are those of
/// the last step and of this one. False and a reason in the report where it cannot go on.   @eq Shen2015:21
bool minimise_newton(const geometry::Ribbon& ribbon, const Options& options, geometry::State& shape,
                     std::vector<double>& multipliers, Workspace& work, StepReport& report);

}  // namespace wunderlich::solver::two_stage
