/// Binary STL: bodies for a printer.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/io/solid.hpp"

namespace wunderlich::io {

/// All bodies in one file, in millimetres as slicers read it, z up. Points that two triangles share are the same
/// bits in both.
std::string stl(const std::vector<Solid>& solids, const std::string& name);

}  // namespace wunderlich::io
