/// The strip unrolled flat, as a drawing to print and cut.
#pragma once

#include <string>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// True scale in millimetres, seen from the front (d1), a layer each: the outline as cut line, of a loop with a tab to
/// glue; where its other end comes to lie, with letters that meet; rulings that fold towards the viewer (valley) and
/// away (mountain), the stronger the fold the darker; a scale bar; a legend.
std::string pattern_svg(const FlatPattern& pattern, const std::string& title);

}  // namespace wunderlich::io
