/// The constraint rows of a chain problem: closure and holds. Internal to solver/.
#pragma once

#include "wunderlich/solver/chain_objective.hpp"

namespace wunderlich::solver {

/// Appends the rows of the closure, then those of each hold; `multipliers` are the current ones, one a row.
void append_rows(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics, const std::vector<double>& multipliers,
                 std::vector<math::ChainRow>& rows);

}  // namespace wunderlich::solver
