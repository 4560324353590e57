#include "wunderlich/scene/run.hpp"

#include "wunderlich/contact/mesh.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/scene/recording.hpp"

namespace wunderlich::scene {

namespace {

geometry::Ribbon ribbon_of(const Scene& scene, const geometry::State& state) {
  return scene.solver.method == Method::equilibrium ? path_ribbon(scene, state) : motion_ribbon(scene, state.time);
}

}  // namespace

RunResult run(const Scene& scene, const Observer& observer, const Progress* resume) {
  return scene.solver.method == Method::equilibrium ? run_path(scene, observer, resume)
                                                    : run_motion(scene, observer, resume);
}

Frame frame_of(const Scene& scene, const geometry::State& state) {
  const geometry::Ribbon ribbon = ribbon_of(scene, state);
  return {state.time, geometry::centerline(ribbon, state),
          geometry::render_mesh(ribbon, state, scene.output.subdivision, scene.output.across)};
}

FlatPattern pattern_of(const Scene& scene, const geometry::State& state) {
  return geometry::flat_pattern(ribbon_of(scene, state), state);
}

std::vector<Body> bodies_of(const Scene& scene, const std::vector<double>& times) {
  std::vector<Body> bodies;
  for (const constraint::Obstacle& obstacle : scene.surroundings.obstacles) {
    // A plane is to reach beyond the strip wherever that may lie on it, and not much farther.
    Body body{contact::mesh_of(obstacle.shape, 2 * scene.ribbon.length), {}};
    for (const double time : times) body.poses.push_back(pose_at(obstacle.motion, time));
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace wunderlich::scene
