/// The strip unrolled flat, as a drawing to print and cut.
#pragma once

#include <string>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// True scale in millimetres, seen from the front (d1): the outline as cut line; rulings that fold towards the
/// viewer (valley) and away (mountain), the stronger the fold the darker.
std::string pattern_svg(const FlatPattern& pattern, const std::string& title);

}  // namespace wunderlich::io
