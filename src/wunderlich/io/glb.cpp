#include "wunderlich/io/glb.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
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

constexpr int ribbon_material = 0, obstacle_material = 1;

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

/// A mesh at rest: its points, normals and triangles.
Json primitive(Buffer& buffer, const Mesh& mesh, int material) {
  std::string indices;
  for (const auto& triangle : mesh.triangles) {
    for (const int point : triangle) append(indices, static_cast<std::uint32_t>(point));
  }
  Json out;
  out["attributes"]["POSITION"] = add_vectors(buffer, mesh.points, nullptr, true);
  out["attributes"]["NORMAL"] = add_vectors(buffer, mesh.normals, nullptr, false);
  out["indices"] = buffer.add(indices, component_uint, "SCALAR", 3 * mesh.triangles.size(), target_indices);
  out["material"] = material;
  return out;
}

/// The ribbon: the first frame, and what the others differ from it by.
Json deforming(Buffer& buffer, const std::vector<Frame>& frames) {
  const Mesh& first = frames.front().surface;
  Json out = primitive(buffer, first, ribbon_material);
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

/// One clip in which everything moves at the same times.
class Animation {
 public:
  Animation(Buffer& buffer, const std::vector<float>& times) : buffer_(buffer) {
    std::string keys;
    for (const float time : times) append(keys, time);
    input_ = buffer.add(keys, component_float, "SCALAR", times.size(), 0);
    buffer.set_bounds(input_, {times.front()}, {times.back()});
    json_ = {{"name", "run"}, {"samplers", Json::array()}, {"channels", Json::array()}};
  }

  void add(std::size_t node, const char* path, const std::string& block, const char* type, std::size_t count) {
    const int output = buffer_.add(block, component_float, type, count, 0);
    json_["channels"].push_back({{"sampler", json_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    json_["samplers"].push_back({{"input", input_}, {"output", output}, {"interpolation", "LINEAR"}});
  }

  const Json& json() const { return json_; }

 private:
  Buffer& buffer_;
  int input_ = 0;
  Json json_;
};

void animate_ribbon(std::size_t frames, Animation& animation) {
  std::string weights;
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t target = 1; target < frames; ++target) append(weights, f == target ? 1.0f : 0.0f);
  }
  animation.add(0, "weights", weights, "SCALAR", frames * (frames - 1));
}

/// A pose with z up as glTF has it, with y up; of the two quaternions the one nearer to the last.
Pose upright(const Pose& pose, const Quat& last) {
  const Quat upward(std::sqrt(0.5), -std::sqrt(0.5), 0, 0);  // a quarter turn about x
  return {upward * pose.position, nearer(upward * pose.frame, last)};
}

void animate_body(std::size_t node, const std::vector<Pose>& poses, Animation& animation) {
  std::string places, frames;
  Quat last = Quat::Identity();
  for (const Pose& given : poses) {
    const Pose pose = upright(given, last);
    last = pose.frame;
    append_float3(places, pose.position);
    for (int k = 0; k < 4; ++k) append(frames, static_cast<float>(pose.frame.coeffs()[k]));
  }
  animation.add(node, "translation", places, "VEC3", poses.size());
  animation.add(node, "rotation", frames, "VEC4", poses.size());
}

Json node(const std::string& name, std::size_t mesh, const Pose& given) {
  const Pose pose = upright(given, Quat::Identity());
  const Vec3& p = pose.position;
  const Vec4 q = pose.frame.coeffs();
  return {
      {"name", name}, {"mesh", mesh}, {"translation", {p.x(), p.y(), p.z()}}, {"rotation", {q[0], q[1], q[2], q[3]}}};
}

Json material(const char* name, const std::array<double, 3>& colour, double roughness) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", roughness}}}};
}

Json describe(Buffer& buffer, const std::vector<Frame>& frames, const std::vector<Body>& bodies,
              const std::string& name) {
  Json out;
  out["asset"] = {{"version", "2.0"}, {"generator", std::string(program) + " " + version}};
  out["scene"] = 0;
  out["scenes"] = Json::array({{{"nodes", {0}}}});
  out["nodes"] = Json::array({node(name, 0, {})});
  out["materials"] = Json::array({material("ribbon", {0.80, 0.36, 0.16}, 0.55)});
  out["meshes"] = Json::array({{{"name", name}, {"primitives", Json::array({deforming(buffer, frames)})}}});
  if (!bodies.empty()) out["materials"].push_back(material("obstacle", {0.62, 0.64, 0.67}, 0.8));
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const std::string label = "obstacle " + std::to_string(k);
    out["scenes"][0]["nodes"].push_back(k + 1);
    out["nodes"].push_back(node(label, k + 1, bodies[k].poses.front()));
    out["meshes"].push_back(
        {{"name", label}, {"primitives", Json::array({primitive(buffer, bodies[k].mesh, obstacle_material)})}});
  }
  if (frames.size() > 1) {
    out["meshes"][0]["weights"] = std::vector<double>(frames.size() - 1, 0.0);
    Animation animation(buffer, key_times(frames));
    animate_ribbon(frames.size(), animation);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (moves(bodies[k])) animate_body(k + 1, bodies[k].poses, animation);
    }
    out["animations"] = Json::array({animation.json()});
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

std::string glb(const std::vector<Frame>& frames, const std::vector<Body>& bodies, const std::string& name) {
  assert(!frames.empty());
  assert(std::all_of(bodies.begin(), bodies.end(), [&](const Body& b) { return b.poses.size() == frames.size(); }));
  Buffer buffer;
  const Json description = describe(buffer, frames, bodies, name);
  std::string chunks;
  add_chunk(chunks, description.dump(-1, ' ', false, Json::error_handler_t::replace), "JSON", ' ');
  add_chunk(chunks, std::move(buffer.bytes), "BIN\0", '\0');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(12 + chunks.size()));
  return out + chunks;
}

}  // namespace wunderlich::io
