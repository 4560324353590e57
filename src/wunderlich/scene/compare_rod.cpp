#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/baseline/rod/energy.hpp"
#include "wunderlich/baseline/rod/motion.hpp"
#include "wunderlich/baseline/rod/surface.hpp"
#include "wunderlich/geometry/isometry.hpp"
#include "wunderlich/scene/compare_models.hpp"
#include "wunderlich/scene/start.hpp"

namespace wunderlich::scene {

namespace rod = baseline::rod;

namespace {

constexpr int kLoadSteps = 20, kMaxHalvings = 8, kAcross = 8;

geometry::RibbonSpec spec_of(const Scene& scene) {
  geometry::RibbonSpec spec = scene.ribbon;
  if (spec.segments != scene.compare.rod_segments) spec.spacing.clear();
  spec.segments = scene.compare.rod_segments;
  return spec;
}

rod::Rod rod_of(const Scene& scene) {
  const geometry::RibbonSpec spec = spec_of(scene);
  const CompareOptions& c = scene.compare;
  return rod::make_rod(spec,
                       c.paper_ratio ? rod::paper_ratio(spec) : rod::physical(spec, c.poisson_ratio, c.thickness));
}

geometry::StripGrid grid_of(const rod::Rod& rod, const rod::State& state) {
  geometry::StripGrid grid{rod.segments, kAcross, rod::surface_points(rod, state, kAcross), {}};
  double u = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    for (int j = 0; j <= kAcross; ++j) grid.flat.emplace_back(u, rod.width * (static_cast<double>(j) / kAcross - 0.5));
    if (i < rod.edges()) u += rod.rest_length[i];
  }
  return grid;
}

/// One run under way.
struct Run {
  Run(const Scene& s, const Observer& observer)
      : scene(s), rod(rod_of(s)), log(s, Model::rod, s.solver.duration, observer) {
    path = scene.solver.method == Method::equilibrium;
    surroundings = scene.surroundings;
    if (rod.segments != scene.ribbon.segments)
      failure = "supports by node: give the rod as many segments as the ribbon";
  }

  const Scene& scene;
  rod::Rod rod;
  ModelLog log;
  constraint::Surroundings surroundings;
  rod::State state;
  rod::Workspace work;
  bool path = false;
  std::string failure;

  void start() {
    if (path) {
      state = rod.is_loop() ? rod::ring_state(rod) : rod::straight_state(rod);
      return;
    }
    const Start start = start_of(scene, motion_ribbon(scene, 0));
    failure = start.failure;
    if (failure.empty()) state = rod::state_from(rod, start.shape);
  }

  rod::Report move_to(double t) {
    if (path) return rod::equilibrium(rod, surroundings, t, {}, state, work);
    return rod::step(rod, surroundings, {scene.compare.damping, scene.compare.damping}, t, {}, state, work);
  }

  /// To t1, in halves where a step fails.
  bool advance(double t1, int halvings, int& iterations) {
    const double t0 = state.time;
    const rod::Report report = move_to(t1);
    iterations += report.iterations;
    if (report.converged()) return true;
    if (halvings == kMaxHalvings) {
      failure = fmt::format("{} (at {:.3g} s)", rod::outcome_name(report.outcome), t1);
      return false;
    }
    return advance(0.5 * (t0 + t1), halvings + 1, iterations) && advance(t1, halvings + 1, iterations);
  }

  bool go() {
    const double duration = scene.solver.duration;
    const double step =
        path ? duration / (scene.solver.steps > 0 ? scene.solver.steps : kLoadSteps) : scene.compare.time_step;
    const long steps = std::lround(std::ceil(duration / step - 1e-9));
    log.frame(state.time, rod::surface_mesh(rod, state, scene.output.across));
    for (long k = path ? 0 : 1; k <= steps; ++k) {  // a path has its supports and loads of time 0 to find first
      const double t = k == steps ? duration : static_cast<double>(k) * step;
      const Stopwatch watch;
      int iterations = 0;
      if (!advance(t, 0, iterations)) return false;
      if (!log.step(t, watch.seconds(), iterations)) return false;
      if (k == steps || log.wants_frame(t)) log.frame(t, rod::surface_mesh(rod, state, scene.output.across));
    }
    return true;
  }
};

}  // namespace

ModelResult run_rod(const Scene& scene, const Observer& observer) {
  Run run(scene, observer);
  ModelResult& result = run.log.result();
  result.method = run.path ? "equilibrium" : "implicit-euler";
  result.resolution = fmt::format("{} edges", run.rod.segments);
  result.unknowns = static_cast<int>(3 * run.rod.nodes() + run.rod.edges());
  if (run.failure.empty()) run.start();
  if (run.failure.empty()) result.converged = run.go();
  if (result.failure.empty()) result.failure = run.failure;
  if (run.state.x.empty()) {
    run.state = rod::straight_state(run.rod);
    run.log.frame(0, rod::surface_mesh(run.rod, run.state, scene.output.across));
  }
  result.energy.elastic = rod::elastic_energy(run.rod, run.state).sum();
  result.energy.normalized =
      result.energy.elastic * scene.ribbon.length / (scene.ribbon.bending_stiffness * scene.ribbon.width);
  result.energy.kinetic = run.path ? 0 : rod::kinetic_energy(run.rod, run.state);
  result.energy.gravity = rod::gravity_energy(run.rod, scene.surroundings.gravity, run.state);
  result.isometry = geometry::isometry_errors(grid_of(run.rod, run.state));
  result.moved_seconds = run.path ? 0 : run.state.time;
  return run.log.finished();
}

}  // namespace wunderlich::scene
