#include "wunderlich/io/glb.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <nlohmann/json.hpp>

#include "wunderlich/base/version.hpp"
#include "wunderlich/io/bytes.hpp"

namespace wunderlich::io {

namespace {

using Json = nlohmann::ordered_json;

// Constants of the glTF 2.0 specification.
constexpr int component_float = 5126;
constexpr int component_uint = 5125;
constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;

/// The binary chunk and the JSON that describes its parts.
struct Buffer {
  std::string bytes;
  Json views = Json::array();
  Json accessors = Json::array();

  /// Index of the new accessor. `target` 0: data of an animation.
  int add(const std::string& block, int component, const char* type, std::size_t count, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", block.size()}};
    if (target != 0) view["target"] = target;
    bytes += block;
    accessors.push_back({{"bufferView", views.size()}, {"componentType", component}, {"count", count}, {"type", type}});
    views.push_back(view);
    return static_cast<int>(accessors.size()) - 1;
  }

  void set_bounds(int accessor, const std::vector<float>& low, const std::vector<float>& high) {
    accessors[static_cast<std::size_t>(accessor)]["min"] = low;
    accessors[static_cast<std::size_t>(accessor)]["max"] = high;
  }
};

/// The vectors, less `base` where there is one.
int add_vectors(Buffer& buffer, const std::vector<Vec3>& vectors, const std::vector<Vec3>* base, bool bounds) {
  std::string block;
  std::vector<float> low(3, std::numeric_limits<float>::max()), high(3, std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Vec3 v = base == nullptr ? vectors[i] : Vec3(vectors[i] - (*base)[i]);
    append_float3(block, v);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], static_cast<float>(v[static_cast<int>(k)]));
      high[k] = std::max(high[k], static_cast<float>(v[static_cast<int>(k)]));
    }
  }
  const int accessor = buffer.add(block, component_float, "VEC3", vectors.size(), target_vertices);
  if (bounds) buffer.set_bounds(accessor, low, high);
  return accessor;
}

Json primitive(Buffer& buffer, const std::vector<Frame>& frames) {
  const Mesh& first = frames.front().surface;
  std::string indices;
  for (const auto& triangle : first.triangles) {
    for (const int point : triangle) append(indices, static_cast<std::uint32_t>(point));
  }
  Json out;
  out["attributes"]["POSITION"] = add_vectors(buffer, first.points, nullptr, true);
  out["attributes"]["NORMAL"] = add_vectors(buffer, first.normals, nullptr, false);
  out["indices"] = buffer.add(indices, component_uint, "SCALAR", 3 * first.triangles.size(), target_indices);
  out["material"] = 0;
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const Mesh& mesh = frames[f].surface;
    assert(mesh.points.size() == first.points.size());
    const int position = add_vectors(buffer, mesh.points, &first.points, true);
    const int normal = add_vectors(buffer, mesh.normals, &first.normals, false);
    out["targets"].push_back({{"POSITION", position}, {"NORMAL", normal}});
  }
  return out;
}

std::vector<float> key_times(const std::vector<Frame>& frames) {
  std::vector<float> times;
  times.reserve(frames.size());
  for (const Frame& frame : frames) times.push_back(static_cast<float>(frame.time - frames.front().time));
  const bool increasing = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
  if (!increasing) {
    for (std::size_t f = 0; f < times.size(); ++f) times[f] = static_cast<float>(f) / 24.0f;
  }
  return times;
}

Json animation(Buffer& buffer, const std::vector<Frame>& frames) {
  const std::vector<float> times = key_times(frames);
  std::string keys, weights;
  for (const float time : times) append(keys, time);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t target = 1; target < frames.size(); ++target) append(weights, f == target ? 1.0f : 0.0f);
  }
  const int input = buffer.add(keys, component_float, "SCALAR", times.size(), 0);
  buffer.set_bounds(input, {times.front()}, {times.back()});
  const int output = buffer.add(weights, component_float, "SCALAR", frames.size() * (frames.size() - 1), 0);
  Json out;
  out["name"] = "run";
  out["samplers"] = Json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}});
  out["channels"] = Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}});
  return out;
}

Json describe(Buffer& buffer, const std::vector<Frame>& frames, const std::string& name) {
  Json out;
  out["asset"] = {{"version", "2.0"}, {"generator", std::string(program) + " " + version}};
  out["scene"] = 0;
  out["scenes"] = Json::array({{{"nodes", {0}}}});
  const double half = std::sqrt(0.5);  // a quarter turn about x: z up becomes y up
  out["nodes"] = Json::array({{{"name", name}, {"mesh", 0}, {"rotation", {-half, 0.0, 0.0, half}}}});
  out["materials"] = Json::array(
      {{{"name", "ribbon"},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.80, 0.36, 0.16, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.55}}}}});
  out["meshes"] = Json::array({{{"name", name}, {"primitives", Json::array({primitive(buffer, frames)})}}});
  if (frames.size() > 1) {
    out["meshes"][0]["weights"] = std::vector<double>(frames.size() - 1, 0.0);
    out["animations"] = Json::array({animation(buffer, frames)});
  }
  out["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}}});
  out["bufferViews"] = buffer.views;
  out["accessors"] = buffer.accessors;
  return out;
}

void add_chunk(std::string& out, std::string chunk, const char* type, char padding) {
  chunk.resize((chunk.size() + 3) / 4 * 4, padding);
  append(out, static_cast<std::uint32_t>(chunk.size()));
  out.append(type, 4);
  out += chunk;
}

}  // namespace

std::string glb(const std::vector<Frame>& frames, const std::string& name) {
  assert(!frames.empty());
  Buffer buffer;
  const Json description = describe(buffer, frames, name);
  std::string chunks;
  add_chunk(chunks, description.dump(-1, ' ', false, Json::error_handler_t::replace), "JSON", ' ');
  add_chunk(chunks, std::move(buffer.bytes), "BIN\0", '\0');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(12 + chunks.size()));
  return out + chunks;
}

}  // namespace wunderlich::io
