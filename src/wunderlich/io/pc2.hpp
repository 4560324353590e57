/// PC2 point cache: the moving points of a mesh whose faces are in an OBJ file beside it.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// One sample a recorded frame, axes and order of the points as in the OBJ.
std::string pc2(const std::vector<Frame>& frames);

}  // namespace wunderlich::io
