/// How far a pair may go on straight ways without coming too near.
#pragma once

#include "wunderlich/contact/pair.hpp"

namespace wunderlich::contact {

/// A share t of the ways from x0 to x1, in [0, 1]: at every share up to t the pair's distance less `offset` [m] is at
/// least `leave` (in [0, 1)) of what it is at x0. The largest such share is not reached: where t < 1 the distance has
/// lost 95 % of what it may lose, unless it stays small on a way a thousand times as long. 0 where the pair touches at
/// x0. Additive advance (Li2021, algorithm 1).
double free_share(PairKind kind, const PairPoints& x0, const PairPoints& x1, double offset, double leave);

}  // namespace wunderlich::contact
