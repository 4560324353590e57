/// Where facets go through each other, by trying all of them: what the solver's own search must keep at none.
#pragma once

#include <span>

#include "wunderlich/solver/self_contact.hpp"

namespace wunderlich::testing {

/// Pairs of facets that meet, of strips with themselves (but for facets up to two apart) and with one another.
int crossings(std::span<const solver::StripPlace> strips);

}  // namespace wunderlich::testing
