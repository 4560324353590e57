/// How well a state keeps the internal constraints, in numbers that mean the same for every ribbon.
#pragma once

#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::constraint {

/// Largest violations: edge length relative to rest length, |e/|e| - d3|, |gamma| and |kappa eta - tau| times the
/// hinge's length, and |w eta'/2|. Strains by the logarithm (all measures have the same zeros).
ConstraintErrors errors(const geometry::Ribbon& ribbon, const geometry::State& state);

}  // namespace wunderlich::constraint
