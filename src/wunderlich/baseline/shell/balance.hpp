/// How far a shell at rest is from a balance of forces.
#pragma once

#include <optional>

#include "wunderlich/baseline/shell/step.hpp"

namespace wunderlich::baseline::shell {

/// Largest net force on a point of those that may move, were the shell let go from rest: mass times the acceleration
/// that bending, gravity and loads give under the constraints, which take what they can [N]. Solids are left out. Empty
/// where the constraints cannot be solved.   @eq Goldenthal2007
std::optional<double> net_force(const Shell& shell, const constraint::Surroundings& surroundings, const State& state);

}  // namespace wunderlich::baseline::shell
