/// Linear complementarity problems of a contact: Eq. 22 with the rows of touching points.   @eq Shen2015:6.3
#pragma once

#include "wunderlich/solver/two_stage/cone_solve.hpp"
#include "wunderlich/solver/two_stage/contact_points.hpp"

namespace wunderlich::solver::two_stage {

/// Rows of what touches: of each touch its normal and, with friction, two tangents; then those of rulings close to
/// meeting. Residuals: gap [m], way beside the solid in this step [m], room of |x|.
void assemble_touches(const geometry::Ribbon& ribbon, const geometry::State& shape, double dt, Workspace& work);

/// Motion that keeps the equations and what touches, with the least |motion|_W, into work.motion; forces into
/// work.cones.force. The equations are eliminated by a banded solve, the rest is small and dense.
bool solve_contact_direct(double tolerance, double enough, int max_sweeps, Workspace& work, StepReport& report);

/// The same with all rows swept together, as the paper does.   @eq Shen2015:22
void solve_contact_sweeps(double tolerance, int max_sweeps, Workspace& work, StepReport& report);

/// Motion that restores the equations alone.
bool solve_equations(Workspace& work);

/// Takes a share of the forces found over into the touches.
void keep_forces(double share, Workspace& work);

}  // namespace wunderlich::solver::two_stage
