#include "wunderlich/picture/lines.hpp"

#include <algorithm>
#include <map>

#include "wunderlich/picture/fields.hpp"

namespace wunderlich::picture {

std::vector<std::array<int, 2>> rim_edges(const Mesh& surface, const std::vector<FlatPattern>& strips) {
  std::map<std::array<int, 2>, int> seen;
  for (const auto& triangle : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      ++seen[{std::min(a, b), std::max(a, b)}];
    }
  }
  const std::vector<double> u = values_of(surface, "u"), ribbon = values_of(surface, "ribbon");
  std::vector<std::array<int, 2>> edges;
  for (const auto& [edge, triangles] : seen) {
    if (triangles != 1) continue;
    const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
    const std::size_t strip = static_cast<std::size_t>(ribbon[a]);
    const bool across = u[a] == u[b];
    if (!(across && strips[strip].loop)) edges.push_back(edge);
  }
  return edges;
}

std::vector<Line> rulings_of(const Frame& frame, const std::vector<FlatPattern>& strips) {
  std::vector<Line> lines;
  for (const CenterlineSample& s : frame.centerline) {
    const Vec3 half = 0.5 * strips[static_cast<std::size_t>(s.ribbon)].width * (s.d2 + s.eta * s.d3);
    lines.push_back({s.r - half, s.r + half});
  }
  return lines;
}

}  // namespace wunderlich::picture
