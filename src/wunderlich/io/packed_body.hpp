/// Obstacles as the pages hold them. Internal to io/.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// A body in single precision; its poses x, y, z and quaternion x, y, z, w, one a frame.
nlohmann::ordered_json body_json(const Mesh& mesh, const std::vector<Pose>& poses);

}  // namespace wunderlich::io
