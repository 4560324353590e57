/// Meshes as the pages hold them: numbers in few bits, as text.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::io {

inline constexpr double largest_count = 65535;

/// The cube in which points are stored as 16-bit numbers.
struct Cube {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 high = Vec3::Constant(std::numeric_limits<double>::lowest());
  double size() const { return std::max((high - low).maxCoeff(), std::numeric_limits<double>::min()); }
  void include(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// At most so many frames, evenly chosen, the first and the last always: at least two of several.
std::vector<const Frame*> chosen_frames(const std::vector<Frame>& frames, std::size_t most);

/// Base64 of x, y, z as 16-bit shares of the cube.
std::string packed_points(const std::vector<Vec3>& points, const Cube& cube);

/// Octahedral map of unit vectors to two 16-bit numbers each (Cigolle et al. 2014).
std::string packed_normals(const std::vector<Vec3>& normals);

/// Indices as 32-bit numbers.
std::string packed_triangles(const Mesh& mesh);

/// JSON that may stand in a script element: no text of the scene can end it.
std::string script_safe(const std::string& json);

/// A page with its data in place of the template's mark.
std::string filled_page(std::string_view page, const std::string& json);

}  // namespace wunderlich::io
