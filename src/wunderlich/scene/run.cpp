#include "wunderlich/scene/run.hpp"

#include <algorithm>

#include "wunderlich/contact/mesh.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/scene/recording.hpp"

namespace wunderlich::scene {

namespace {

/// Adds one mesh to another with the same fields.
void append(const Mesh& part, Mesh& whole) {
  const auto first = static_cast<int>(whole.points.size());
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  whole.normals.insert(whole.normals.end(), part.normals.begin(), part.normals.end());
  for (const auto& t : part.triangles) whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  if (whole.fields.empty()) whole.fields.resize(part.fields.size());
  for (std::size_t f = 0; f < part.fields.size(); ++f) {
    auto& values = whole.fields[f].values;
    values.insert(values.end(), part.fields[f].values.begin(), part.fields[f].values.end());
    whole.fields[f].name = part.fields[f].name;
    whole.fields[f].unit = part.fields[f].unit;
  }
}

}  // namespace

geometry::Ribbon ribbon_of(const Scene& strip, const geometry::State& state) {
  return strip.solver.method == Method::equilibrium ? path_ribbon(strip, state) : motion_ribbon(strip, state.time);
}

RunResult run(const Scene& scene, const Observer& observer, const Progress* resume) {
  return scene.solver.method == Method::equilibrium ? run_path(scene, observer, resume)
                                                    : run_motion(scene, observer, resume);
}

std::vector<const Scene*> strips_of(const Scene& scene) {
  std::vector<const Scene*> strips{&scene};
  for (const Scene& strip : scene.beside) strips.push_back(&strip);
  return strips;
}

Frame frame_of(const Scene& scene, const Record& record) {
  const std::vector<const Scene*> strips = strips_of(scene);
  Frame frame;
  frame.time = record.states.front().time;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const geometry::State& state = record.states[i];
    const geometry::Ribbon ribbon = ribbon_of(*strips[i], state);
    Mesh mesh = geometry::render_mesh(ribbon, state, scene.output.subdivision, scene.output.across);
    std::vector<CenterlineSample> line = geometry::centerline(ribbon, state);
    for (CenterlineSample& sample : line) sample.ribbon = static_cast<int>(i);
    frame.centerline.insert(frame.centerline.end(), line.begin(), line.end());
    if (strips.size() > 1) {
      mesh.fields.push_back({"ribbon", "", std::vector<double>(mesh.points.size(), static_cast<double>(i))});
    }
    append(mesh, frame.surface);
  }
  return frame;
}

std::vector<FlatPattern> patterns_of(const Scene& scene, const Record& record) {
  const std::vector<const Scene*> strips = strips_of(scene);
  std::vector<FlatPattern> patterns;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    patterns.push_back(geometry::flat_pattern(ribbon_of(*strips[i], record.states[i]), record.states[i]));
    patterns.back().thickness = strips[i]->thickness;
  }
  return patterns;
}

std::vector<Body> bodies_of(const Scene& scene, const std::vector<double>& times) {
  std::vector<Body> bodies;
  for (const constraint::Obstacle& obstacle : scene.surroundings.obstacles) {
    // A plane is to reach beyond the strip wherever that may lie on it, and not much farther.
    double length = 0;
    for (const Scene* strip : strips_of(scene)) length = std::max(length, strip->ribbon.length);
    Body body{contact::mesh_of(obstacle.shape, 2 * length), {}};
    for (const double time : times) body.poses.push_back(pose_at(obstacle.motion, time));
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace wunderlich::scene
