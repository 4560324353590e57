#include "wunderlich/scene/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/build.hpp"
#include "wunderlich/scene/file_text.hpp"
#include "wunderlich/scene/mesh_text.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

constexpr std::size_t longest_path = 4096;
constexpr std::size_t largest_file = std::size_t{4} << 20;

const ShippedScene* find_shipped(const std::string& name) {
  for (const ShippedScene& scene : shipped_scenes()) {
    if (scene.name == name) return &scene;
  }
  return nullptr;
}

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const ShippedScene& scene : shipped_scenes()) names.push_back(scene.name);
  return names;
}

[[noreturn]] void fail_missing(const std::string& name) {
  const std::string guess = nearest(name, shipped_names());
  throw InputError(fmt::format("{}: no such file, and no shipped scene of this name{}; shipped are {}", shown(name),
                               guess.empty() ? "" : fmt::format(" (did you mean `{}`?)", guess),
                               joined(shipped_names())));
}

std::string scene_text(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail_missing(path);
  return file_text(path, largest_file, "a scene, which is a YAML file");
}

double last_key_time(const constraint::Surroundings& surroundings) {
  double last = 0;
  for (const auto& support : surroundings.supports) last = std::max(last, end_time(support.motion));
  for (const auto& load : surroundings.loads) last = std::max(last, load.keys.back().time);
  for (const auto& obstacle : surroundings.obstacles) last = std::max(last, end_time(obstacle.motion));
  return last;
}

std::string place_of(const Cell& cell) { return described(cell.place) + ": " + cell.path; }

std::vector<std::string> places_of(const Cell& list) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < count(list); ++i) {
    places.push_back(place_of(element(list, i)));
  }
  return places;
}

}  // namespace

Scene read_scene_text(const std::string& text, const std::string& source, const std::vector<std::string>& overrides) {
  Value document = parse_document(text, shown(source, longest_path));
  Scene scene;
  const std::string folder = std::filesystem::path(source).parent_path().string();
  embed_meshes(folder, document);
  if (document.kind == Value::Kind::map) scene.written = to_yaml(document);
  if (!overrides.empty() && document.kind == Value::Kind::map) {
    for (const std::string& assignment : overrides) apply_override(document, assignment);
    embed_meshes(folder, document);
  }
  check_document(document);
  const Cell root = root_cell(document);
  scene.name = std::filesystem::path(source).stem().string();
  const Cell title = child(root, "title");
  scene.title = title.value == nullptr ? scene.name : title.value->text;
  scene.ribbon = build_ribbon(root);
  scene.surroundings = build_surroundings(root, scene.ribbon);
  scene.obstacle_places = places_of(child(root, "obstacles"));
  if (const Cell contact = child(root, "contact"); contact.value != nullptr) scene.contact_place = place_of(contact);
  scene.initial = build_initial(root, scene.ribbon);
  scene.solver = build_solver(root, scene.ribbon, last_key_time(scene.surroundings));
  scene.output = build_output(root, scene.ribbon);
  scene.resolved = to_yaml(document);
  return scene;
}

Scene read_scene(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  if (const ShippedScene* shipped = find_shipped(name_or_path)) {
    return read_scene_text(shipped->text, "scenes/" + shipped->name + ".yaml", overrides);
  }
  return read_scene_text(scene_text(name_or_path), name_or_path, overrides);
}

}  // namespace wunderlich::scene
