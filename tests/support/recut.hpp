/// A closed loop cut at another node: the same body, other numbers. What depends on the cut is a bug of the seam.
#pragma once

#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::testing {

/// The ribbon whose node 0 is the old node `node`.
geometry::Ribbon recut(const geometry::Ribbon& ribbon, int node);

/// Its state: nodes and frames that now come after the seam are seen from the other side. Needs a state with
/// r_n = r_0 and eta_n = seam_sign eta_0 where positions and eta matter.
geometry::State recut(const geometry::Ribbon& ribbon, const geometry::State& state, int node);

}  // namespace wunderlich::testing
