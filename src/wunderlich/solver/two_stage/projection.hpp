/// Eq. 22: the nearest (q, eta) that keeps gamma = 0, kappa eta = tau and |x| < 1, by Newton's method in the range
/// space of the constraints, metric |dq|^2 + |d eta|^2 as printed.   @eq Shen2015:22
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Three rows a block: gamma h, (kappa eta - tau) h, and the ruling bound of the segment that starts at its node where
/// it is active. Steps of two linear solvers alternate with linearisations until the constraints hold.
/// Returns whether they do; `shape` is moved either way.
bool project(const geometry::Ribbon& ribbon, const Options& options, geometry::State& shape, Workspace& work,
             StepReport& report);

}  // namespace wunderlich::solver::two_stage
