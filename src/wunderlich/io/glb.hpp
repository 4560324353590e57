/// Binary glTF 2.0: the ribbon, animated by morph targets.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// One mesh, one target a frame after the first; plays at the recorded times, counted from the first frame, or at
/// 24 frames a second where these do not increase. Turned from z up to the y up of glTF by its node. All frames
/// share the connectivity of the first.
std::string glb(const std::vector<Frame>& frames, const std::string& name);

}  // namespace wunderlich::io
