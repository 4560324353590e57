/// Supports and loads of a scene at an instant, for the solvers that step in time. Internal to scene/.
#pragma once

#include "wunderlich/geometry/state.hpp"
#include "wunderlich/scene/scene.hpp"
#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::scene {

/// What holds and loads the strip in the step from `t0` to `t1`. Loads in material axes turn with `state`.
solver::two_stage::Drive drive_between(const Scene& scene, const geometry::Ribbon& ribbon, const geometry::State& state,
                                       double t0, double t1);

/// Is the support still there in a step that starts at `time`?
bool holds(const constraint::Support& support, double time);

}  // namespace wunderlich::scene
