/// Binary glTF 2.0: the ribbon, animated by morph targets, and the solids beside it.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// The ribbon is node 0: one mesh, one target a frame after the first. Every body is a node of its own, with a pose for
/// each frame; one that moves does so in the same clip. Plays at the recorded times, counted from the first frame, or
/// at 24 frames a second where these do not increase. Nodes turn z up into the y up of glTF. All frames share the
/// connectivity of the first.
std::string glb(const std::vector<Frame>& frames, const std::vector<Body>& bodies, const std::string& name);

}  // namespace wunderlich::io
