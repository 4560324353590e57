/// The path's own state as numbers, for checkpoints.
#pragma once

#include <vector>

#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

std::vector<double> pack_cursor(const solver::PathState& state);

/// Throws InputError if the numbers do not fit the path.
solver::PathState unpack_cursor(const solver::PathProblem& path, const std::vector<double>& cursor);

}  // namespace wunderlich::scene
