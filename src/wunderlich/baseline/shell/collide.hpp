/// Keeping a shell's points out of solids.
#pragma once

#include "wunderlich/baseline/shell/hold.hpp"
#include "wunderlich/constraint/support.hpp"

namespace wunderlich::baseline::shell {

struct State;

/// Moves free points out of the obstacles of `t1` along the nearest way, and takes from their slip along the surface
/// since `before` up to the friction coefficient times that push: a filter of the velocity after the projection, as
/// cloth has it; lengths are right again only after the next step. Returns the number of points pushed.
int push_out(const Shell& shell, const constraint::Surroundings& surroundings, const Hold& hold, const State& before,
             double t1, Points& x);

}  // namespace wunderlich::baseline::shell
