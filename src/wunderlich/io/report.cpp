#include "wunderlich/io/report.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/packed_body.hpp"
#include "wunderlich/io/packed_mesh.hpp"
#include "wunderlich/io/summary_json.hpp"

namespace wunderlich::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t byte_budget = 6u << 20;  // of the moving points, before base64

std::array<Vec3, 2> ruling_ends(const CenterlineSample& sample, const std::vector<FlatPattern>& strips) {
  const Vec3 half = 0.5 * strips[static_cast<std::size_t>(sample.ribbon)].width * (sample.d2 + sample.eta * sample.d3);
  return {sample.r - half, sample.r + half};
}

Cube bounding_cube(const std::vector<const Frame*>& frames, const std::vector<FlatPattern>& strips) {
  Cube cube;
  for (const Frame* frame : frames) {
    for (const Vec3& p : frame->surface.points) cube.include(p);
    for (const CenterlineSample& sample : frame->centerline) {
      for (const Vec3& p : ruling_ends(sample, strips)) cube.include(p);
    }
  }
  return cube;
}

template <class Get>
std::string column(const std::vector<CenterlineSample>& centerline, Get get) {
  std::string out;
  for (const CenterlineSample& sample : centerline) append(out, static_cast<float>(get(sample)));
  return base64(out);
}

Json frame_json(const Frame& frame, const Cube& cube, const std::vector<FlatPattern>& strips) {
  std::vector<Vec3> rulings;
  for (const CenterlineSample& sample : frame.centerline) {
    for (const Vec3& p : ruling_ends(sample, strips)) rulings.push_back(p);
  }
  const auto& line = frame.centerline;
  return {{"time", frame.time},
          {"points", packed_points(frame.surface.points, cube)},
          {"normals", packed_normals(frame.surface.normals)},
          {"rulings", packed_points(rulings, cube)},
          {"kappa", column(line, [](const CenterlineSample& s) { return s.kappa; })},
          {"tau", column(line, [](const CenterlineSample& s) { return s.tau; })},
          {"eta", column(line, [](const CenterlineSample& s) { return s.eta; })}};
}

/// Where each strip begins on the common axis: one behind the other.
std::vector<double> beginnings(const std::vector<FlatPattern>& strips) {
  std::vector<double> out{0};
  for (const FlatPattern& strip : strips) out.push_back(out.back() + strip.length);
  return out;
}

/// u on the common axis, and v.
Json mesh_json(const Mesh& mesh, const std::vector<double>& begin) {
  Json out = {{"triangles", packed_triangles(mesh)}};
  const auto ribbon = std::find_if(mesh.fields.begin(), mesh.fields.end(),
                                   [](const PointField& field) { return field.name == "ribbon"; });
  for (const PointField& field : mesh.fields) {
    if (field.name != "u" && field.name != "v") continue;
    std::string values;
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      const bool moved = field.name == "u" && ribbon != mesh.fields.end();
      const double before = moved ? begin[static_cast<std::size_t>(ribbon->values[i])] : 0;
      append(values, static_cast<float>(field.values[i] + before));
    }
    out[field.name] = base64(values);
  }
  return out;
}

Json history_json(const std::vector<HistoryRow>& history) {
  Json out = {{"time", Json::array()},    {"elastic", Json::array()},    {"kinetic", Json::array()},
              {"gravity", Json::array()}, {"total", Json::array()},      {"normalized", Json::array()},
              {"length", Json::array()},  {"torsion", Json::array()},    {"ruling", Json::array()},
              {"area", Json::array()},    {"iterations", Json::array()}, {"step_us", Json::array()}};
  for (const HistoryRow& row : history) {
    out["time"].push_back(row.time);
    out["elastic"].push_back(row.energy.elastic);
    out["kinetic"].push_back(row.energy.kinetic);
    out["gravity"].push_back(row.energy.gravity);
    out["total"].push_back(row.energy.total());
    out["normalized"].push_back(row.energy.normalized);
    out["length"].push_back(row.constraints.max_length_error);
    out["torsion"].push_back(row.constraints.max_torsion_mismatch);
    out["ruling"].push_back(row.constraints.max_ruling_ratio);
    out["area"].push_back(row.area_error);
    out["iterations"].push_back(row.iterations);
    out["step_us"].push_back(row.step_us);
  }
  return out;
}

Json report_json(const RunOutput& output) {
  const Frame& first = output.frames.front();
  const std::size_t bytes = 10 * first.surface.points.size() + 24 * first.centerline.size();  // of a frame
  const std::vector<const Frame*> frames = chosen_frames(output.frames, byte_budget / std::max<std::size_t>(1, bytes));
  const std::vector<FlatPattern>& strips = output.patterns;
  const std::vector<double> begin = beginnings(strips);
  const Cube cube = bounding_cube(frames, strips);
  Json data;
  data["title"] = output.title;
  data["summary"] = Json::parse(summary_json(output.summary));
  data["parameters"] = output.parameters;
  data["scene"] = output.scene_text;
  data["length"] = begin.back();
  data["width"] = strips.front().width;
  data["history"] = history_json(output.history);
  data["recorded_frames"] = output.frames.size();
  data["low"] = {cube.low.x(), cube.low.y(), cube.low.z()};
  data["scale"] = cube.size() / largest_count;
  data["mesh"] = mesh_json(frames.front()->surface, begin);
  data["bodies"] = Json::array();
  for (const Body& body : output.bodies) {
    std::vector<Pose> poses;
    poses.reserve(frames.size());
    for (const Frame* frame : frames)
      poses.push_back(body.poses[static_cast<std::size_t>(frame - output.frames.data())]);
    data["bodies"].push_back(body_json(body.mesh, poses));
  }
  data["u"] = column(frames.front()->centerline,
                     [&](const CenterlineSample& s) { return begin[static_cast<std::size_t>(s.ribbon)] + s.u; });
  data["frames"] = Json::array();
  for (const Frame* frame : frames) data["frames"].push_back(frame_json(*frame, cube, strips));
  return data;
}

}  // namespace

std::string report_page(const RunOutput& output) {
  assert(!output.frames.empty());
  return filled_page(output.report_template, report_json(output).dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace wunderlich::io
