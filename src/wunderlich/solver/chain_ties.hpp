/// Springs and dashpots of a chain problem: to anchors, and on the hinges. Internal to solver/.
#pragma once

#include "wunderlich/solver/chain_objective.hpp"

namespace wunderlich::solver {

/// Middle, d3 and d2 of segment i as columns: what a FacetTie ties.
Mat3 facet_of(const geometry::Ribbon& ribbon, const geometry::Kinematics& kinematics, std::size_t i);

/// Their value [J].
double tie_value(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics);

/// Adds their derivatives to links that are filled, and pose terms, by decreasing node, to a system without any.
void add_ties(const geometry::Ribbon& ribbon, const ChainProblem& problem, const geometry::Chain& chain,
              const geometry::Kinematics& kinematics, math::ChainSystem& system);

}  // namespace wunderlich::solver
