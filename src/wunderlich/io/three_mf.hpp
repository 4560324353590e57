/// 3MF: bodies for a printer, with their unit and a name each.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/io/solid.hpp"

namespace wunderlich::io {

/// A zip of XML by the 3MF core specification 1.3, in millimetres, z up; an object a body.
std::string three_mf(const std::vector<Solid>& solids, const std::string& name);

}  // namespace wunderlich::io
