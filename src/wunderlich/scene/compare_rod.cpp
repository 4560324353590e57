#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/baseline/rod/energy.hpp"
#include "wunderlich/baseline/rod/motion.hpp"
#include "wunderlich/baseline/rod/surface.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/geometry/isometry.hpp"
#include "wunderlich/scene/compare_models.hpp"
#include "wunderlich/scene/start.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

namespace rod = baseline::rod;

namespace {

constexpr int kLoadSteps = 20;

rod::Rod rod_of(const Scene& scene) {
  const geometry::RibbonSpec& spec = scene.ribbon;
  const CompareOptions& c = scene.compare;
  return rod::make_rod(spec,
                       c.paper_ratio ? rod::paper_ratio(spec) : rod::physical(spec, c.poisson_ratio, c.thickness));
}

/// What the scene asks for and the rod leaves out.
std::vector<std::string> left_out(const Scene& scene) {
  std::vector<std::string> notes;
  const constraint::Surroundings& s = scene.surroundings;
  const bool rubs = std::any_of(s.obstacles.begin(), s.obstacles.end(),
                                [](const constraint::Obstacle& obstacle) { return obstacle.friction > 0; });
  if (rubs || (s.contact.self && s.contact.friction > 0)) notes.emplace_back("friction is not modelled by the rod");
  if (s.contact.self) notes.emplace_back("the rod does not feel itself: it may pass through itself");
  if (scene.solver.method == Method::equilibrium) return notes;
  if (scene.solver.method == Method::two_stage &&
      scene.solver.two_stage.ode.damping == solver::two_stage::Damping::per_step) {
    notes.emplace_back("damping by factors a step is not modelled by the rod");
  }
  if (scene.solver.method == Method::implicit && scene.solver.implicit.viscosity > 0)
    notes.emplace_back("damping of the material is not modelled by the rod");
  return notes;
}

/// Where the rod itself stands at a support.
Pose own_pose(const rod::Rod& rod, const rod::State& state, const constraint::Support& support) {
  const int edge = std::min(support.segment >= 0 ? support.segment : support.node, rod.segments - 1);
  const rod::Section s = rod::section(state, static_cast<std::size_t>(edge));
  Mat3 frame;
  frame << s.m1, s.m2, s.m3;
  return {state.x[static_cast<std::size_t>(support.node)], Quat(frame)};
}

double last_event(const constraint::Surroundings& surroundings) {
  double last = 0;
  for (const constraint::Support& support : surroundings.supports) {
    last = std::max(last, end_time(support.motion));
    if (std::isfinite(support.release)) last = std::max(last, support.release);
  }
  for (const constraint::Load& load : surroundings.loads) last = std::max(last, load.keys.back().time);
  return last;
}

/// One run under way.
struct RodRun {
  RodRun(const Scene& s, const Observer& observer)
      : scene(with_segments(s, s.compare.rod_segments)),
        rod(rod_of(scene)),
        log(s, Model::rod, s.solver.duration, 1, observer),
        path(s.solver.method == Method::equilibrium) {}

  Scene scene;  ///< on as many segments as the rod has
  rod::Rod rod;
  ModelLog log;
  bool path;
  constraint::Surroundings approach;  ///< of a path, to its start
  bool approaching = false;
  rod::State state;
  rod::Workspace work;
  int resting = 0;  ///< steps for which it has been slow

  /// Straight, on its first support, or a ring; a motion starts where the ribbon's does. Why not, else empty.
  std::string start() {
    if (!path) {
      const Start start = start_of(scene, motion_ribbon(scene, 0));
      if (!start.failure.empty()) return start.failure;
      state = rod::state_from(rod, start.shape);
      for (std::size_t j = 0; j < rod.edges(); ++j)
        state.theta_dot[j] = scene.initial.spin.dot((state.x[j + 1] - state.x[j]).normalized());
      return {};
    }
    if (rod.is_loop()) {
      state = rod::ring_state(rod);
      return {};
    }
    const geometry::Ribbon ribbon = geometry::make_ribbon(scene.ribbon);
    const solver::PathState start = solver::start_path(solver::make_path(ribbon, scene.surroundings, {}));
    state = rod::state_from(rod, geometry::state_of(ribbon, start.chain, 0));
    return {};
  }

  Tried step_to(double t) {
    const CompareOptions& c = scene.compare;
    if (approaching) approach.gravity = t * scene.surroundings.gravity;
    const rod::Report report =
        path ? rod::equilibrium(rod, approaching ? approach : scene.surroundings, t, {}, state, work)
             : rod::step(rod, scene.surroundings, {c.damping_tangent, c.damping}, t, {}, state, work);
    return {report.iterations, report.converged() ? "" : rod::outcome_name(report.outcome)};
  }

  /// As slow as a ribbon that counts as resting.
  bool is_slow() const {
    const geometry::RibbonSpec& spec = scene.ribbon;
    const double slow = 1e-5 * std::sqrt(spec.bending_stiffness / spec.area_density) / spec.length;
    return state.time >= last_event(scene.surroundings) &&
           std::all_of(state.v.begin(), state.v.end(), [&](const Vec3& v) { return v.norm() < slow; });
  }

  bool is_over() {
    resting = !path && is_slow() ? resting + 1 : 0;
    return scene.solver.stop_at_rest && resting >= kRestingSteps;
  }

  Mesh surface() const { return rod::surface_mesh(rod, state, scene.output.across); }

  bool go() {
    const double duration = scene.solver.duration;
    const double step =
        path ? duration / (scene.solver.steps > 0 ? scene.solver.steps : kLoadSteps) : scene.compare.time_step;
    const Stepped stepped{[this](double t) { return step_to(t); }, [this] { return is_over(); },
                          [this] { return surface(); }};
    log.frame(0, surface());
    if (path) {
      std::vector<Pose> own;
      for (const constraint::Support& support : scene.surroundings.supports)
        own.push_back(own_pose(rod, state, support));
      approach = approach_to(scene.surroundings, own);
      approaching = true;
      if (!log.approach(stepped, 1, is_away(approach, rod.length) ? kLoadSteps : 1)) return false;
      approaching = false;
      state.time = 0;
    }
    return log.run(stepped, step);
  }
};

}  // namespace

ModelResult run_rod(const Scene& scene, const Observer& observer) {
  RodRun run(scene, observer);
  ModelResult& result = run.log.result();
  result.method = run.path ? "equilibrium" : "implicit-euler";
  result.resolution = fmt::format("{} edges", run.rod.segments);
  result.unknowns = 4 * run.rod.segments + (run.rod.is_loop() ? 0 : 3);  // a loop's last node is its first
  result.notes = left_out(scene);
  if (const double shift = largest_shift(scene, run.scene); shift > 1e-9 * scene.ribbon.length)
    result.notes.push_back(fmt::format("supports or loads stand up to {:.2g} m from their places on the strip", shift));
  result.failure = fallen_together(scene, run.scene);
  if (result.failure.empty()) result.failure = run.start();
  if (result.failure.empty()) result.converged = run.go();
  if (run.state.x.empty()) {
    run.state = rod::straight_state(run.rod);
    run.log.frame(0, run.surface());
  }
  result.energy.elastic = rod::elastic_energy(run.rod, run.state).sum();
  result.energy.kinetic = run.path ? 0 : rod::kinetic_energy(run.rod, run.state);
  result.energy.gravity = rod::gravity_energy(run.rod, scene.surroundings.gravity, run.state);
  result.isometry = geometry::isometry_errors(rod::surface_grid(run.rod, run.state, kAcross));
  result.moved_seconds = run.path ? 0 : run.state.time;
  if (run.path && result.converged)
    result.imbalance = rod::net_force(run.rod, run.scene.surroundings, run.state, run.work);
  return run.log.finished();
}

}  // namespace wunderlich::scene
