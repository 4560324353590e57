/// Wavefront OBJ: a surface at rest.
#pragma once

#include <string>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// Points in their order, with normals; z up.
std::string obj(const Mesh& mesh, const std::string& name);

}  // namespace wunderlich::io
