/// Strips of a recorded instant, as searches for what touches see them.
#pragma once

#include <vector>

#include "wunderlich/scene/run.hpp"
#include "wunderlich/solver/corner_sums.hpp"

namespace wunderlich::scene {

struct Placed {
  std::vector<geometry::Ribbon> ribbons;  ///< as they are held: a loop before it closes is cut
  std::vector<geometry::Ribbon> whole;    ///< as they will be
  std::vector<geometry::Chain> chains;
  std::vector<geometry::Kinematics> kinematics;
  std::vector<solver::StripPlace> places;
};

/// All strips of the scene; in a loop `out` is used again.
void place(const Scene& scene, const Record& record, Placed& out);

}  // namespace wunderlich::scene
