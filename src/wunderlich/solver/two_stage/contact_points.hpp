/// Where the reconstructed surface meets round solids and boxes: fixed material points S(u, v) with the solid's normal.
/// @eq Shen2015:6.3
#pragma once

#include "wunderlich/solver/two_stage/contact_touch.hpp"

namespace wunderlich::solver::two_stage {

/// The solids at both ends of a substep.
void set_solids(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, double t0, double t1,
                Workspace& work);

/// Looks at all points of a shape and adds those that are inside a solid to the touches: of a facet, which is flat, the
/// deepest and the outermost, since others say the same.
void find_points(const geometry::Ribbon& ribbon, const geometry::State& shape, double tolerance, Nearest& nearest,
                 Workspace& work);

/// Normal and gap of a touch where the strip now is.
void refresh_point(const geometry::State& shape, const Workspace& work, Touch& touch);

}  // namespace wunderlich::solver::two_stage
