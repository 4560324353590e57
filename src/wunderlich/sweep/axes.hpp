/// The axes of a sweep file. Internal to sweep/.
#pragma once

#include "wunderlich/sweep/reader.hpp"
#include "wunderlich/sweep/spec.hpp"

namespace wunderlich::sweep {

/// One entry of `axes`: values or a range of a key, `zip` of several, or samples of several ranges.
Axis read_axis(const Node& entry);

}  // namespace wunderlich::sweep
