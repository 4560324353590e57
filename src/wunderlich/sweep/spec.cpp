#include "wunderlich/sweep/spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "wunderlich/base/error.hpp"
#include "wunderlich/base/version.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/scene/file_text.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/text.hpp"
#include "wunderlich/sweep/axes.hpp"
#include "wunderlich/sweep/figures.hpp"

namespace wunderlich::sweep {

namespace {

constexpr std::size_t kLargestFile = std::size_t{4} << 20, kMostAxes = 20, kMostCollected = 200;
constexpr double kMostRuns = 1e7;
const std::vector<std::string> kFields{"kappa", "tau", "eta", "x", "y", "z"};
const std::vector<std::string> kFormats{"vtp", "glb", "pc2", "obj", "stl", "3mf", "svg", "html", "png", "mp4"};

/// A shipped scene, a file beside the sweep, or the scene itself.
void read_base(const Node& node, const std::string& folder, Sweep& sweep) {
  if (!node) refuse(node, "is missing; give the name of a shipped scene, a file, or the scene itself");
  if (node.value->kind == scene::Value::Kind::map) {
    sweep.scene_text = scene::to_yaml(*node.value);
    return;
  }
  const std::string name = word(node);
  const auto& shipped = scene::shipped_scenes();
  const bool is_shipped =
      std::any_of(shipped.begin(), shipped.end(), [&](const scene::ShippedScene& s) { return s.name == name; });
  const scene::Scene base = scene::read_scene(is_shipped ? name : (std::filesystem::path(folder) / name).string());
  sweep.scene_name = base.name;
  sweep.scene_text = base.written;
}

void read_set(const Node& map, Sweep& sweep) {
  if (!map) return;
  if (map.value->kind != scene::Value::Kind::map) refuse(map, "must be a map from keys of the scene to values");
  for (std::size_t i = 0; i < map.value->items.size(); ++i) {
    const Node item{&map.value->items[i], map.path + "." + map.value->names[i], map.value->items[i].place};
    const scene::Value& value = *item.value;
    std::string text = value.text;
    if (value.kind != scene::Value::Kind::scalar) {  // a list or map in one line
      scene::Value holder;
      holder.kind = scene::Value::Kind::map;
      holder.names = {"v"};
      holder.items = {value};
      text = scene::to_yaml(holder).substr(5);
      if (!text.empty() && text.back() == '\n') text.pop_back();
    }
    sweep.assignments.push_back(map.value->names[i] + "=" + text);
  }
}

void read_collected(const Node& map, Sweep& sweep) {
  if (!map) refuse(map, "is missing; give a map from names of columns to figures, such as {energy: energy.normalized}");
  if (map.value->kind != scene::Value::Kind::map || map.value->items.empty() ||
      map.value->items.size() > kMostCollected) {
    refuse(map, "must be a map from names of columns to figures, such as {energy: energy.normalized}");
  }
  for (std::size_t i = 0; i < map.value->items.size(); ++i) {
    const Node item{&map.value->items[i], map.path + "." + map.value->names[i], map.value->items[i].place};
    const std::string path = word(item);
    if (!is_figure(path)) {
      const std::string guess = scene::nearest(path, figure_names());
      refuse(item, fmt::format("`{}` is no figure of a run{} There are: {}", scene::shown(path),
                               guess.empty() ? "." : fmt::format("; did you mean `{}`?", guess),
                               scene::joined(figure_names())));
    }
    sweep.collected.push_back({map.value->names[i], path});
  }
}

std::vector<std::string> some_of(const Node& list, const std::vector<std::string>& allowed) {
  std::vector<std::string> out;
  if (!list) return out;
  for (const Node& item : elements(list, allowed.size())) {
    const std::string text = word(item);
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      refuse(item, fmt::format("`{}` is not allowed; must be one of {}", scene::shown(text), scene::joined(allowed)));
    }
    out.push_back(text);
  }
  return out;
}

std::string key_part(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

/// No key is set by two axes, no column stands twice, and the scene takes every value, each tried alone.
void check_axes(const std::vector<Node>& entries, const Node& collect, const Sweep& sweep) {
  std::set<std::string> columns{"run", "key", "status", "reason", "run_seconds"}, keys;
  for (const Collected& result : sweep.collected) {
    if (!columns.insert(result.name).second)
      refuse(collect, fmt::format("`{}` is the name of another column", result.name));
  }
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    for (const std::string& name : sweep.axes[a].columns) {
      if (!columns.insert(name).second)
        refuse(entries[a], fmt::format("column `{}` stands twice; give a `name`", name));
    }
    for (const std::string& assignment : sweep.axes[a].points.front().assignments) {
      const std::string key = key_part(assignment);
      if (!keys.insert(key).second) refuse(entries[a], fmt::format("`{}` is set twice", key));
    }
  }
  double runs = 1;
  for (const Axis& axis : sweep.axes) runs *= static_cast<double>(axis.points.size());
  if (runs > kMostRuns) refuse(entries.back(), fmt::format("makes {:g} runs; at most {:g}", runs, kMostRuns));
  constexpr std::size_t kTried = 10;  // of an axis: more would take longer than some sweeps
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const std::size_t count = sweep.axes[a].points.size(), tried = std::min(count, kTried);
    for (std::size_t k = 0; k < tried; ++k) {
      const std::size_t i = tried == 1 ? 0 : k * (count - 1) / (tried - 1);
      std::vector<std::string> assignments = sweep.assignments;
      for (std::size_t b = 0; b < sweep.axes.size(); ++b) {
        const AxisPoint& point = sweep.axes[b].points[a == b ? i : 0];
        assignments.insert(assignments.end(), point.assignments.begin(), point.assignments.end());
      }
      try {
        scene::read_scene_text(sweep.scene_text, sweep.scene_name + ".yaml", assignments);
      } catch (const InputError& error) {
        refuse(entries[a], fmt::format("value {}: {}", i + 1, error.what()));
      }
    }
  }
}

/// The file with its base scene inside, so that it can be read anywhere.
std::string standing_alone(const scene::Value& document, const Sweep& sweep) {
  scene::Value copy = document;
  scene::Value* base = copy.find("scene");
  if (base != nullptr) *base = scene::parse_document(sweep.scene_text, sweep.scene_name);
  const auto add = [&](const char* name, const std::string& text) {
    if (copy.find(name) != nullptr) return;
    scene::Value value;
    value.kind = scene::Value::Kind::scalar;
    value.text = text;
    copy.names.push_back(name);
    copy.name_places.push_back(document.place);
    copy.items.push_back(std::move(value));
  };
  add("name", sweep.name);
  add("scene_name", sweep.scene_name);
  return scene::to_yaml(copy);
}

}  // namespace

Sweep read_sweep(const std::string& path) {
  return read_sweep_text(scene::file_text(path, kLargestFile, "a sweep, which is a YAML file"), path);
}

Sweep read_sweep_text(const std::string& text, const std::string& source) {
  const scene::Value document = scene::parse_document(text, source);
  const Node root{&document, "", document.place};
  require_keys(root, {"name", "title", "scene", "set", "axes", "collect", "fields", "keep", "timeout", "scene_name"});
  Sweep sweep;
  sweep.name = child(root, "name") ? word(child(root, "name")) : std::filesystem::path(source).stem().string();
  if (sweep.name.find('/') != std::string::npos || sweep.name.front() == '.') {
    refuse(child(root, "name"), "must be a name for a folder, without `/` and not beginning with a dot");
  }
  sweep.title = child(root, "title") ? word(child(root, "title")) : sweep.name;
  sweep.scene_name = child(root, "scene_name") ? word(child(root, "scene_name")) : sweep.name;
  read_base(child(root, "scene"), std::filesystem::path(source).parent_path().string(), sweep);
  read_set(child(root, "set"), sweep);
  read_collected(child(root, "collect"), sweep);
  sweep.fields = some_of(child(root, "fields"), kFields);
  sweep.keep = some_of(child(root, "keep"), kFormats);
  if (const Node timeout = child(root, "timeout")) sweep.timeout = number(timeout, 1e-3, 1e9);
  const std::vector<Node> entries = elements(child(root, "axes"), kMostAxes);
  for (const Node& entry : entries) sweep.axes.push_back(read_axis(entry));
  check_axes(entries, child(root, "collect"), sweep);
  sweep.text = standing_alone(document, sweep);
  return sweep;
}

std::size_t run_count(const Sweep& sweep) {
  std::size_t count = 1;
  for (const Axis& axis : sweep.axes) count *= axis.points.size();
  return count;
}

std::vector<std::size_t> place_of(const Sweep& sweep, std::size_t run) {
  std::vector<std::size_t> place(sweep.axes.size());
  for (std::size_t a = sweep.axes.size(); a-- > 0;) {
    place[a] = run % sweep.axes[a].points.size();
    run /= sweep.axes[a].points.size();
  }
  return place;
}

std::vector<std::string> assignments_of(const Sweep& sweep, std::size_t run) {
  std::vector<std::string> out = sweep.assignments;
  const std::vector<std::size_t> place = place_of(sweep, run);
  for (std::size_t a = 0; a < place.size(); ++a) {
    const auto& assignments = sweep.axes[a].points[place[a]].assignments;
    out.insert(out.end(), assignments.begin(), assignments.end());
  }
  return out;
}

std::string key_of(const Sweep& sweep, std::size_t run) {
  std::string what = std::string(version) + "\n" + sweep.scene_text;
  for (const std::string& assignment : assignments_of(sweep, run)) what += "\n" + assignment;
  for (const std::string& field : sweep.fields) what += "\nfield " + field;
  for (const std::string& format : sweep.keep) what += "\nkeep " + format;
  return fmt::format("{:016x}", io::checksum(what));
}

}  // namespace wunderlich::sweep
