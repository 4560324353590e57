/// The banded Newton system of stage opt: Hessian of the Lagrangian over frames and rulings, bordered by the
/// constraints. Six rows a node, eta, theta, then the multipliers of the node's hinge after what they hold.
#pragma once

#include <array>

#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::solver::two_stage {

/// How much of the second derivatives is taken.
enum class Curvature {
  exact,  ///< all, with the multipliers'
  safe,   ///< without those of the strains in the angles, and without the multipliers'
};

/// Row of a block in the banded system; loops are folded.
int block_row(const geometry::Ribbon& ribbon, int block);

/// Assembles work.system at the jets and link terms of the last objective_gradient. `shift` is added to the diagonal of
/// the unknowns, in units of D w/l on theta and D l/w on eta.
void assemble_kkt(const geometry::Ribbon& ribbon, const Options& options, const geometry::State& shape,
                  const std::vector<double>& multipliers, Curvature curvature, double shift, Workspace& work);

/// Factors work.system into work.factored; true if exactly the multipliers' pivots are negative.
bool factor_kkt(const geometry::Ribbon& ribbon, Workspace& work);

/// Solves for the step from work.gradient and work.residual into work.step, and the new multipliers.
void solve_kkt(const geometry::Ribbon& ribbon, Workspace& work, std::vector<double>& multipliers);

/// The step that takes back work.residual, as found after a step, with the same factors; into work.correction.
void solve_correction(const geometry::Ribbon& ribbon, Workspace& work);

}  // namespace wunderlich::solver::two_stage
