#include "wunderlich/io/packed_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>

#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/packed_body.hpp"

namespace wunderlich::io {

std::vector<const Frame*> chosen_frames(const std::vector<Frame>& frames, std::size_t most) {
  const std::size_t count = std::min(std::max<std::size_t>(2, most), frames.size());
  std::vector<const Frame*> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(&frames[count == 1 ? 0 : k * (frames.size() - 1) / (count - 1)]);
  }
  return out;
}

std::string packed_points(const std::vector<Vec3>& points, const Cube& cube) {
  std::string out;
  for (const Vec3& p : points) {
    for (int k = 0; k < 3; ++k) {
      append(out, static_cast<std::uint16_t>(std::lround((p[k] - cube.low[k]) / cube.size() * largest_count)));
    }
  }
  return base64(out);
}

std::string packed_normals(const std::vector<Vec3>& normals) {
  std::string out;
  for (const Vec3& n : normals) {
    Vec2 p = Vec2(n.x(), n.y()) / n.lpNorm<1>();
    if (n.z() < 0) {
      p = Vec2((1 - std::abs(p.y())) * std::copysign(1.0, p.x()), (1 - std::abs(p.x())) * std::copysign(1.0, p.y()));
    }
    for (int k = 0; k < 2; ++k) append(out, static_cast<std::int16_t>(std::lround(p[k] * 32767)));
  }
  return base64(out);
}

std::string packed_triangles(const Mesh& mesh) {
  std::string triangles;
  for (const auto& triangle : mesh.triangles) {
    for (const int point : triangle) append(triangles, static_cast<std::uint32_t>(point));
  }
  return base64(triangles);
}

nlohmann::ordered_json body_json(const Mesh& mesh, const std::vector<Pose>& poses) {
  std::string points, normals, places;
  for (const Vec3& p : mesh.points) append_float3(points, p);
  for (const Vec3& n : mesh.normals) append_float3(normals, n);
  for (const Pose& pose : poses) {
    append_float3(places, pose.position);
    append_float3(places, pose.frame.vec());
    append(places, static_cast<float>(pose.frame.w()));
  }
  return {{"points", base64(points)},
          {"normals", base64(normals)},
          {"triangles", packed_triangles(mesh)},
          {"poses", base64(places)}};
}

std::string script_safe(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string filled_page(std::string_view page, const std::string& json) {
  constexpr std::string_view placeholder = "\"__WUNDERLICH_DATA__\"";
  const std::size_t position = page.find(placeholder);
  assert(position != std::string_view::npos && "the page has no place for the data");
  std::string out(page.substr(0, position));
  out += script_safe(json);
  out += page.substr(position + placeholder.size());
  return out;
}

}  // namespace wunderlich::io
