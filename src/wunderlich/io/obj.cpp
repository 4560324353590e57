#include "wunderlich/io/obj.hpp"

#include <fmt/format.h>

#include <iterator>

namespace wunderlich::io {

std::string obj(const Mesh& mesh, const std::string& name) {
  std::string out = fmt::format("# metres, z up\no {}\n", name);
  auto end = std::back_inserter(out);
  for (const Vec3& p : mesh.points) fmt::format_to(end, "v {} {} {}\n", p.x(), p.y(), p.z());
  for (const Vec3& n : mesh.normals) fmt::format_to(end, "vn {} {} {}\n", n.x(), n.y(), n.z());
  out += "s 1\n";
  for (const auto& t : mesh.triangles) {
    fmt::format_to(end, "f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return out;
}

}  // namespace wunderlich::io
