/// How the strip winds: twist, writhe and linking number of a state, and the zeros of its curvature.
#pragma once

#include <vector>

#include "wunderlich/base/summary.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::geometry {

/// Turns of d1 about the centerline, positive right-handed about d3: the sum over the hinges of the angle, within
/// half a turn, from the parallel-transported d1 of one segment to that of the next. Clamped end frames and the
/// seam of a loop included.
double twist(const Ribbon& ribbon, const State& state);

/// Writhe of the centerline polygon [turns], closed for a loop: the Gauss integral summed exactly over pairs of
/// straight segments (Klenin and Langowski 2000, method 1a). Coplanar pairs count 0, also where they cross.
double writhe(const Ribbon& ribbon, const State& state);

/// For a loop `link` is half_twists/2 up to whole turns, to rounding; for an open strip it is no invariant.
Topology topology(const Ribbon& ribbon, const State& state);

/// Where the curvature changes its sign, as u/length in [0, 1), increasing; linear between nodes.
/// `kappa` by node as in `Strains`. A loop is followed across its seam, where kappa may change its sign with the
/// surface without being zero.
std::vector<double> kappa_zeros(const Ribbon& ribbon, const std::vector<double>& kappa);

}  // namespace wunderlich::geometry
