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

constexpr std::size_t longest_shown = 4096;
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

const char* const strip_sections[] = {"clamps", "pins", "forces", "initial"};

/// The scene as one of several strips sees it: its entry in `ribbons` as if it were the only ribbon.
Value document_of_strip(const Value& document, std::size_t index) {
  const Value& entry = document.find("ribbons")->items[index];
  const std::string place = fmt::format("ribbons.{}", index);
  Value out = document;
  const auto add = [&](const std::string& name, Value value, const std::string& alias, const Place& where) {
    value.alias = alias;
    out.names.push_back(name);
    out.name_places.push_back(where);
    out.items.push_back(std::move(value));
  };
  Value ribbon = entry;
  ribbon.items.clear(), ribbon.names.clear(), ribbon.name_places.clear();
  for (std::size_t k = 0; k < entry.items.size(); ++k) {
    const std::string& name = entry.names[k];
    if (std::find(std::begin(strip_sections), std::end(strip_sections), name) != std::end(strip_sections)) {
      add(name, entry.items[k], place + "." + name, entry.name_places[k]);
    } else {
      ribbon.names.push_back(name);
      ribbon.name_places.push_back(entry.name_places[k]);
      ribbon.items.push_back(entry.items[k]);
    }
  }
  add("ribbon", std::move(ribbon), place, entry.place);
  return out;
}

/// What belongs to one strip must not stand beside several; and what several can do.
void check_ribbons(const Cell& root) {
  const Cell ribbons = child(root, "ribbons");
  if (ribbons.value == nullptr) return;
  if (child(root, "ribbon").value != nullptr) fail(child(root, "ribbon"), "contradicts `ribbons`; give one of the two");
  for (const char* section : strip_sections) {
    const Cell cell = child(root, section);
    if (cell.value != nullptr) fail(cell, fmt::format("of which strip? It belongs into an entry of `ribbons`"));
  }
  if (count(ribbons) == 0) fail(ribbons, "has no entry; must have one for each strip");
  if (count(ribbons) == 1) return;
  if (method_of(root) != Method::implicit) fail(ribbons, "several strips move with `solver.method: implicit` only");
  const Cell conserve = child(child(root, "solver"), "conserve");
  if (boolean(conserve)) fail(conserve, "is for one strip alone");
}

/// What the scene says of one strip and all that surrounds it.
void build_strip(const Cell& root, Scene& scene) {
  scene.ribbon = build_ribbon(root);
  const Cell thickness = child(child(root, "ribbon"), "thickness");
  scene.thickness = thickness.value != nullptr ? number(thickness) : 0;
  scene.surroundings = build_surroundings(root, scene.ribbon);
  scene.obstacle_places = places_of(child(root, "obstacles"));
  if (const Cell contact = child(root, "contact"); contact.value != nullptr) scene.contact_place = place_of(contact);
  scene.initial = build_initial(root, scene.ribbon);
  scene.solver = build_solver(root, scene.ribbon, last_key_time(scene.surroundings));
  scene.output = build_output(root, scene.ribbon);
  scene.compare = build_compare(root, scene.ribbon, scene.solver);
}

/// All strips. Those after the first are the first one's scene but for what is theirs.
void build_strips(const Value& document, Scene& scene) {
  double duration = 0;
  std::vector<Scene> strips;
  for (std::size_t i = 0; i < document.find("ribbons")->items.size(); ++i) {
    const Value alone = document_of_strip(document, i);
    Scene& strip = strips.emplace_back(scene);
    build_strip(root_cell(alone), strip);
    const Cell name = child(child(root_cell(alone), "ribbon"), "name");
    strip.ribbon_name = name.value != nullptr ? name.value->text : std::to_string(i + 1);
    duration = std::max(duration, strip.solver.duration);
  }
  for (Scene& strip : strips) strip.solver.duration = duration;
  scene = strips.front();
  scene.beside.assign(std::make_move_iterator(strips.begin() + 1), std::make_move_iterator(strips.end()));
}

}  // namespace

Scene read_scene_text(const std::string& text, const std::string& source, const std::vector<std::string>& overrides) {
  Value document = parse_document(text, shown(source, longest_shown));
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
  check_ribbons(root);
  if (document.find("ribbons") != nullptr) {
    build_strips(document, scene);
  } else {
    build_strip(root, scene);
  }
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
