#include "wunderlich/io/stl.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/millimetres.hpp"

namespace wunderlich::io {

namespace {

constexpr std::size_t comment_size = 80, triangle_size = 50;

void append_triangle(std::string& out, const Vec3& a, const Vec3& b, const Vec3& c) {
  append_float3(out, (b - a).cross(c - a).normalized());
  for (const Vec3* p : {&a, &b, &c}) append_float3(out, mm * *p);
  append(out, std::uint16_t{0});
}

}  // namespace

std::string stl(const std::vector<Solid>& solids, const std::string& name) {
  std::size_t count = 0;
  for (const Solid& solid : solids) count += solid.triangles.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(fmt::format("{} triangles are more than STL can hold; lower output.subdivision", count));
  }
  std::string out = "binary, mm, z up: " + name;  // must not begin with "solid": that would mean text
  out.resize(comment_size - 1, ' ');
  out += '\0';  // for readers that take it for a C string
  out.reserve(comment_size + 4 + triangle_size * count);
  append(out, static_cast<std::uint32_t>(count));
  for (const Solid& solid : solids) {
    const auto at = [&](int i) -> const Vec3& { return solid.points[static_cast<std::size_t>(i)]; };
    for (const auto& t : solid.triangles) append_triangle(out, at(t[0]), at(t[1]), at(t[2]));
  }
  return out;
}

}  // namespace wunderlich::io
