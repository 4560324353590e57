/// The paper's rule for rulings where the strip is flat and the energy does not say where they point.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// In every run of hinges with |kappa| w below `flat_curvature`, at the refreshed strains, makes eta as small as the
/// ruling bound allows next to the rulings at the run's ends: min int eta^2 under |eta'| < 2/w has that solution in
/// closed form. Returns how many rulings changed.   @eq Shen2015:8
int flatten_rulings(const geometry::Ribbon& ribbon, double flat_curvature, geometry::State& shape,
                    const Workspace& work);

}  // namespace wunderlich::solver::two_stage
