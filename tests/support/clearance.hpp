/// How near strips come to themselves and to one another, by trying all facets: apart from the solver's own search.
#pragma once

#include <span>

#include "wunderlich/solver/self_contact.hpp"

namespace wunderlich::testing {

/// Smallest distance from points of a grid on each facet to every other facet [m], but for facets of one strip whose
/// stretches of the flat pattern are no more than `apart` from each other.
double clearance(std::span<const solver::StripPlace> strips, double apart);

}  // namespace wunderlich::testing
