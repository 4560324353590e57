/// The elastic energy with eta' by the central difference of Eq. 10, as printed: kept for comparison.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// V = sum over hinges of (D w h/2) phi(x) E, x = (w/2)(eta_{i+1} - eta_{i-1})/(l^{i-1} + l^i) [J]; one-sided at the
/// ends. Adds its gradient by unknown where `gradient` is given.   @eq Shen2015:11
double central_elastic(const geometry::Ribbon& ribbon, const energy::Model& model, const geometry::State& shape,
                       const Workspace& work, std::vector<double>* gradient);

}  // namespace wunderlich::solver::two_stage
