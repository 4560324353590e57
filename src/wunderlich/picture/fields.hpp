/// Fields of a mesh by their names. Internal to picture/.
#pragma once

#include <string_view>
#include <vector>

#include "wunderlich/base/frame.hpp"

namespace wunderlich::picture {

/// Zeros where there is no such field: all points of a single strip are of ribbon 0.
inline std::vector<double> values_of(const Mesh& surface, std::string_view name) {
  for (const PointField& field : surface.fields) {
    if (field.name == name) return field.values;
  }
  return std::vector<double>(surface.points.size(), 0.0);
}

}  // namespace wunderlich::picture
