#include "wunderlich/solver/touching.hpp"

#include <algorithm>

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

void find_touching(const Ribbon& ribbon, const Touchable& problem, const Chain& chain, const Kinematics& kinematics,
                   SelfSearch& search, Touching& touching) {
  const StripPlace place{ribbon, chain, kinematics};
  touching.points.clear();
  if (problem.self.active()) find_pairs({&place, 1}, problem.self, search, touching.self);
  if (!problem.contact.empty()) find_points(ribbon, problem.contact, chain, kinematics, touching.points);
}

bool go_touching(const Ribbon& ribbon, const Touchable& problem, const Touching& from, const Chain& chain,
                 const Kinematics& kinematics, SelfSearch& search, Touching& to) {
  to.points.clear();
  if (!problem.contact.empty()) {
    find_points(ribbon, problem.contact, chain, kinematics, to.points);
    if (!may_go(problem.contact, from.points, to.points)) return false;
  }
  const StripPlace place{ribbon, chain, kinematics};
  return !problem.self.active() || travel({&place, 1}, problem.self, from.self, search, to.self);
}

double touching_energy(const Ribbon& ribbon, const Touchable& problem, const Touching& touching) {
  double energy = 0;
  if (problem.self.active()) energy += self_energy(problem.self, touching.self);
  if (!problem.contact.empty()) energy += contact_energy(ribbon, problem.contact, touching.points);
  return energy;
}

double smallest_distance(const Touchable& problem, const Touching& touching) {
  const double solids = smallest_distance(problem.contact, touching.points);
  return problem.self.active() ? std::min(solids, smallest_distance(problem.self, touching.self)) : solids;
}

int contact_count(const Touchable& problem, const Touching& touching) {
  const int own = problem.self.active() ? static_cast<int>(touching.self.pairs.size()) : 0;
  return contact_count(touching.points) + own;
}

}  // namespace wunderlich::solver
