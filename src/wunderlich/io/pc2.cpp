#include "wunderlich/io/pc2.hpp"

#include <cassert>

#include "wunderlich/io/bytes.hpp"

namespace wunderlich::io {

std::string pc2(const std::vector<Frame>& frames) {
  assert(!frames.empty());
  std::string out("POINTCACHE2\0", 12);
  const std::size_t points = frames.front().surface.points.size();
  append(out, std::int32_t{1});  // version
  append(out, static_cast<std::int32_t>(points));
  append(out, 0.0f);  // first frame
  append(out, 1.0f);  // frames a sample
  append(out, static_cast<std::int32_t>(frames.size()));
  for (const Frame& frame : frames) {
    assert(frame.surface.points.size() == points);
    for (const Vec3& p : frame.surface.points) append_float3(out, p);
  }
  return out;
}

}  // namespace wunderlich::io
