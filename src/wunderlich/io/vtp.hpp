/// VTK poly data for ParaView: one `.vtp` an instant, one `.pvd` that lists them.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

/// The surface with normals and all its point fields in single precision, appended raw; the time as field data.
std::string vtp(const Mesh& mesh, double time);

/// All bodies as they stand in a frame of the run.
std::string vtp(const std::vector<Body>& bodies, std::size_t frame, double time);

/// The collection file; `files` relative to it, one a time.
std::string pvd(const std::vector<double>& times, const std::vector<std::string>& files);

}  // namespace wunderlich::io
