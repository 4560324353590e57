#include "wunderlich/io/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "wunderlich/base/version.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/obj.hpp"
#include "wunderlich/io/output_folder.hpp"
#include "wunderlich/io/packed_body.hpp"
#include "wunderlich/io/packed_mesh.hpp"

namespace wunderlich::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t point_budget = 1u << 19;  // moving points of one model in the page

using Figure = std::optional<double>;  // empty where it says nothing of a model

struct Column {
  const char* name;
  Figure (*value)(const ModelResult&);
  bool of_model = false;  // known before it moves
};

/// Time a simulated second; a path of equilibria has none.
Figure per_second(const ModelResult& m) { return m.moved_seconds > 0 ? m.wall_seconds / m.moved_seconds : 0; }

constexpr std::array<Column, 19> columns{{
    {"unknowns", [](const ModelResult& m) -> Figure { return static_cast<double>(m.unknowns); }, true},
    {"constraints", [](const ModelResult& m) -> Figure { return static_cast<double>(m.constraints); }, true},
    {"elastic", [](const ModelResult& m) -> Figure { return m.energy.elastic; }},
    {"normalized", [](const ModelResult& m) -> Figure { return m.energy.normalized; }},
    {"kinetic", [](const ModelResult& m) -> Figure { return m.energy.kinetic; }},
    {"gravity", [](const ModelResult& m) -> Figure { return m.energy.gravity; }},
    {"area_error", [](const ModelResult& m) -> Figure { return m.isometry.area; }},
    {"diagonal_strain", [](const ModelResult& m) -> Figure { return m.isometry.diagonal; }},
    {"rim_stretch", [](const ModelResult& m) -> Figure { return m.isometry.rim; }},
    {"imbalance", [](const ModelResult& m) { return m.imbalance; }},
    {"length_error", [](const ModelResult& m) -> Figure { return m.length_error; }},
    {"missed_steps", [](const ModelResult& m) -> Figure { return m.missed_steps; }},
    {"steps", [](const ModelResult& m) -> Figure { return static_cast<double>(m.steps); }},
    {"iterations_mean", [](const ModelResult& m) -> Figure { return m.iterations; }},
    {"step_us_median", [](const ModelResult& m) -> Figure { return m.step_us; }},
    {"wall_seconds", [](const ModelResult& m) -> Figure { return m.wall_seconds; }},
    {"moved_seconds", [](const ModelResult& m) -> Figure { return m.moved_seconds; }},
    {"wall_per_second", per_second},
    {"frames", [](const ModelResult& m) -> Figure { return static_cast<double>(m.frames.size()); }},
}};

/// What says something of a shape, or of steps, says nothing of a model that never moved.
Figure figure(const ModelResult& model, const Column& column) {
  if (model.steps == 0 && !column.of_model) return std::nullopt;
  const Figure value = column.value(model);
  if (value && !std::isfinite(*value))
    throw std::domain_error(fmt::format("{}: {} is not finite", model.model, column.name));
  return value;
}

Json number_json(double value) {
  return value == std::floor(value) && std::abs(value) < 1e15 ? Json(static_cast<long>(value)) : Json(value);
}

Json model_json(const ModelResult& model) {
  Json out = {{"model", model.model}, {"method", model.method}, {"resolution", model.resolution}};
  for (const Column& column : columns) {
    const Figure value = figure(model, column);
    out[column.name] = value ? number_json(*value) : Json(nullptr);
  }
  out["converged"] = model.converged;
  if (!model.failure.empty()) out["failure"] = model.failure;
  if (!model.notes.empty()) out["notes"] = model.notes;
  for (const auto& [name, us] : model.phases_us) out["phases_us"][name] = us;
  return out;
}

Json shapes_json(const ModelResult& model, const std::vector<Body>& bodies) {
  const std::size_t each = std::max<std::size_t>(1, model.frames.front().surface.points.size());
  const std::vector<const Frame*> frames = chosen_frames(model.frames, point_budget / each);
  Cube cube;
  for (const Frame* frame : frames) {
    for (const Vec3& p : frame->surface.points) cube.include(p);
  }
  Json out = model_json(model);
  out["low"] = {cube.low.x(), cube.low.y(), cube.low.z()};
  out["scale"] = cube.size() / largest_count;
  out["triangles"] = packed_triangles(frames.front()->surface);
  out["frames_shown"] = Json::array();
  for (const Frame* frame : frames) {
    out["frames_shown"].push_back({{"time", frame->time},
                                   {"points", packed_points(frame->surface.points, cube)},
                                   {"normals", packed_normals(frame->surface.normals)}});
  }
  out["bodies"] = Json::array();
  for (const Body& body : bodies) {
    std::vector<Pose> poses;
    poses.reserve(frames.size());
    for (const Frame* frame : frames)
      poses.push_back(body.poses[static_cast<std::size_t>(frame - model.frames.data())]);
    out["bodies"].push_back(body_json(body.mesh, poses));
  }
  return out;
}

}  // namespace

std::string comparison_csv(const Comparison& comparison) {
  std::string out = "model,method,resolution,converged";
  for (const Column& column : columns) out += fmt::format(",{}", column.name);
  out += "\n";
  for (const ModelResult& model : comparison.models) {
    out += fmt::format("{},{},{},{}", model.model, model.method, model.resolution, model.converged ? 1 : 0);
    for (const Column& column : columns) {
      const Figure value = figure(model, column);
      out += value ? fmt::format(",{}", *value) : ",";
    }
    out += "\n";
  }
  return out;
}

std::string comparison_json(const Comparison& comparison) {
  Json out = {{"program", program}, {"version", version}, {"scene", comparison.scene}, {"models", Json::array()}};
  for (const ModelResult& model : comparison.models) out["models"].push_back(model_json(model));
  return out.dump(2) + "\n";
}

std::string comparison_page(const Comparison& comparison, std::string_view page) {
  Json data = {{"scene", comparison.scene}, {"title", comparison.title}, {"text", comparison.scene_text},
               {"program", program},        {"version", version},        {"models", Json::array()}};
  for (std::size_t i = 0; i < comparison.models.size(); ++i) {
    data["models"].push_back(shapes_json(comparison.models[i], comparison.bodies[i]));
  }
  return filled_page(page, data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

bool is_comparison(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path file = folder / "comparison.json";
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const Json data = Json::parse(read_file(file, std::size_t{1} << 24), nullptr, false);
  if (!data.is_object() || data.value("program", "") != program) return false;
  std::set<std::string> ours{"comparison.json", "comparison.csv", "report.html"};
  for (const Json& model : data.value("models", Json::array())) {
    if (model.is_object() && model.contains("model") && model["model"].is_string())
      ours.insert(model["model"].get<std::string>() + ".obj");
  }
  // Whatever else is there is somebody else's, and stays.
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (ours.count(entry.path().filename().string()) == 0) return false;
  }
  return !error;
}

void write_comparison(const std::filesystem::path& folder, const Comparison& comparison, std::string_view page) {
  write_whole_folder(folder, is_comparison, [&](const FolderWriter& write) {
    write({{"comparison.json", comparison_json(comparison)},
           {"comparison.csv", comparison_csv(comparison)},
           {"report.html", comparison_page(comparison, page)}});
    for (const ModelResult& model : comparison.models) {
      write({{model.model + ".obj", obj(model.frames.back().surface, model.model)}});
    }
  });
}

}  // namespace wunderlich::io
