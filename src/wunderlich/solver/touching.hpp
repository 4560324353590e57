/// All that one chain alone touches: solids, and its own parts.
#pragma once

#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/self_contact.hpp"

namespace wunderlich::solver {

struct Touching {
  ContactPoints points;  ///< beside solids
  SelfContacts self;
};

/// What there is to touch.
struct Touchable {
  const ContactProblem& contact;
  const SelfContact& self;
  bool empty() const { return contact.empty() && !self.active(); }
};

/// Of a chain as it lies.
void find_touching(const geometry::Ribbon& ribbon, const Touchable& problem, const geometry::Chain& chain,
                   const geometry::Kinematics& kinematics, SelfSearch& search, Touching& touching);

/// The same at the end of a way; false if something is in the way, and `to` may then not be complete.
bool go_touching(const geometry::Ribbon& ribbon, const Touchable& problem, const Touching& from,
                 const geometry::Chain& chain, const geometry::Kinematics& kinematics, SelfSearch& search,
                 Touching& to);

/// Energy of all barriers [J].
double touching_energy(const geometry::Ribbon& ribbon, const Touchable& problem, const Touching& touching);

/// Smallest distance beyond the thickness [m]; where nothing is near a bound from below.
double smallest_distance(const Touchable& problem, const Touching& touching);

/// Points beside solids and pairs of its own parts that feel something.
int contact_count(const Touchable& problem, const Touching& touching);

}  // namespace wunderlich::solver
