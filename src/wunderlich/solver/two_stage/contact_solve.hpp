/// Linear complementarity problems of a contact: Eq. 22 with the rows of touching points.   @eq Shen2015:6.3
#pragma once

#include "wunderlich/solver/two_stage/cone_solve.hpp"
#include "wunderlich/solver/two_stage/contact_touch.hpp"

namespace wunderlich::solver::two_stage {

/// Motion of a touch along a direction; with `rulings` also that which turning rulings bring.
void touch_row(const geometry::Ribbon& ribbon, const geometry::State& shape, const Touch& touch, const Vec3& direction,
               bool rulings, const Workspace& work, Row& row);

/// Rows of what touches: of each touch its normal and, with friction, two tangents; then those of rulings close to
/// meeting. Residuals: gap [m], way beside the solid in this step [m], room of |x|.
void assemble_touches(const geometry::Ribbon& ribbon, const geometry::State& shape, Workspace& work);

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
