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

constexpr int kLoadSteps = 20, kMaxHalvings = 8, kRestingSteps = 20, kAcross = 8;

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

/// What brings a rod to the surroundings of time 0 while time goes from 0 to 1: supports come from where it is, loads
/// grow from nothing. Solids stand.
constraint::Surroundings approach_to(const constraint::Surroundings& surroundings, const rod::Rod& rod,
                                     const rod::State& state) {
  constraint::Surroundings out = surroundings;
  for (constraint::Support& support : out.supports) {
    const Pose goal = constraint::pose_at(support.motion, 0);
    support.motion.keys = {{0, own_pose(rod, state, support), 0}, {1, goal, 0}};
  }
  for (constraint::Load& load : out.loads) {
    const constraint::LoadKey key = constraint::load_at(load, 0);
    load.keys = {{0, Vec3::Zero(), Vec3::Zero()}, {1, key.force, key.torque}};
  }
  for (constraint::Obstacle& obstacle : out.obstacles)
    obstacle.motion.keys = {{0, constraint::pose_at(obstacle.motion, 0), 0}};
  return out;
}

/// Is any support elsewhere than the rod has it?
bool is_away(const constraint::Surroundings& approach, double length) {
  constexpr double kThere = 1e-9;
  return std::any_of(approach.supports.begin(), approach.supports.end(), [&](const constraint::Support& support) {
    const Pose &own = support.motion.keys.front().pose, &goal = support.motion.keys.back().pose;
    const Vec3 way = goal.position - own.position;
    for (int c = 0; c < 3; ++c) {
      if (support.hold_position[static_cast<std::size_t>(c)] && std::abs(way[c]) > kThere * length) return true;
    }
    return support.orientation == constraint::Orientation::full && own.frame.angularDistance(goal.frame) > kThere;
  });
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
struct Run {
  Run(const Scene& s, const Observer& observer)
      : scene(with_segments(s, s.compare.rod_segments)),
        rod(rod_of(scene)),
        log(s, Model::rod, s.solver.duration, observer),
        path(s.solver.method == Method::equilibrium) {}

  Scene scene;  ///< on as many segments as the rod has
  rod::Rod rod;
  ModelLog log;
  bool path;
  constraint::Surroundings approach;  ///< of a path, to its start
  bool approaching = false;
  rod::State state;
  rod::Workspace work;
  std::string failure;

  /// Straight, on its first support, or a ring; a motion starts where the ribbon's does.
  void start() {
    if (!path) {
      const Start start = start_of(scene, motion_ribbon(scene, 0));
      failure = start.failure;
      if (failure.empty()) state = rod::state_from(rod, start.shape);
      return;
    }
    if (rod.is_loop()) {
      state = rod::ring_state(rod);
      return;
    }
    const geometry::Ribbon ribbon = geometry::make_ribbon(scene.ribbon);
    const solver::PathState start = solver::start_path(solver::make_path(ribbon, scene.surroundings, {}));
    state = rod::state_from(rod, geometry::state_of(ribbon, start.chain, 0));
  }

  rod::Report move_to(double t) {
    const CompareOptions& c = scene.compare;
    if (!path) return rod::step(rod, scene.surroundings, {c.damping_tangent, c.damping}, t, {}, state, work);
    if (approaching) approach.gravity = t * scene.surroundings.gravity;
    return rod::equilibrium(rod, approaching ? approach : scene.surroundings, t, {}, state, work);
  }

  /// To t1, in halves where a step fails.
  bool advance(double t1, int halvings, int& iterations) {
    const double t0 = state.time;
    const rod::Report report = move_to(t1);
    iterations += report.iterations;
    if (report.converged()) return true;
    if (halvings == kMaxHalvings) {
      failure = approaching ? fmt::format("{} (on its way to the start)", rod::outcome_name(report.outcome))
                            : fmt::format("{} (at {:.3g} s)", rod::outcome_name(report.outcome), t1);
      return false;
    }
    return advance(0.5 * (t0 + t1), halvings + 1, iterations) && advance(t1, halvings + 1, iterations);
  }

  /// One step of the log, in `parts` equal steps.
  bool logged_step(double t, int parts) {
    const Stopwatch watch;
    const double t0 = state.time;
    int iterations = 0;
    for (int k = 1; k <= parts; ++k) {
      if (!advance(k == parts ? t : t0 + (t - t0) * k / parts, 0, iterations)) return false;
    }
    return log.step(approaching ? 0 : t, watch.seconds(), iterations);
  }

  /// To equilibrium with the supports and loads of time 0.
  bool reach_start() {
    approach = approach_to(scene.surroundings, rod, state);
    approaching = true;
    if (!logged_step(1, is_away(approach, rod.length) ? kLoadSteps : 1)) return false;
    approaching = false;
    state.time = 0;
    return true;
  }

  /// As slow as a ribbon that counts as resting.
  bool is_slow() const {
    const geometry::RibbonSpec& spec = scene.ribbon;
    const double slow = 1e-5 * std::sqrt(spec.bending_stiffness / spec.area_density) / spec.length;
    return state.time >= last_event(scene.surroundings) &&
           std::all_of(state.v.begin(), state.v.end(), [&](const Vec3& v) { return v.norm() < slow; });
  }

  void draw() { log.frame(state.time, rod::surface_mesh(rod, state, scene.output.across)); }

  bool go() {
    const double duration = scene.solver.duration;
    const double step =
        path ? duration / (scene.solver.steps > 0 ? scene.solver.steps : kLoadSteps) : scene.compare.time_step;
    const long steps = std::lround(std::ceil(duration / step - 1e-9));
    draw();
    if (path && !reach_start()) return false;
    int resting = 0;
    for (long k = 1; k <= steps; ++k) {
      const double t = k == steps ? duration : static_cast<double>(k) * step;
      if (!logged_step(t, 1)) return false;
      resting = !path && is_slow() ? resting + 1 : 0;
      const bool over = k == steps || (scene.solver.stop_at_rest && resting >= kRestingSteps);
      if (over || log.wants_frame(t)) draw();
      if (over) break;
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
  result.unknowns = 4 * run.rod.segments + (run.rod.is_loop() ? 0 : 3);  // a loop's last node is its first
  result.notes = left_out(scene);
  if (const double shift = largest_shift(scene, run.scene); shift > 1e-9 * scene.ribbon.length)
    result.notes.push_back(fmt::format("supports or loads stand up to {:.2g} m from their places on the strip", shift));
  run.failure = fallen_together(scene, run.scene);
  if (run.failure.empty()) run.start();
  if (run.failure.empty()) result.converged = run.go();
  if (result.failure.empty()) result.failure = run.failure;
  if (run.state.x.empty()) {
    run.state = rod::straight_state(run.rod);
    run.draw();
  }
  result.energy.elastic = rod::elastic_energy(run.rod, run.state).sum();
  result.energy.normalized =
      result.energy.elastic * scene.ribbon.length / (scene.ribbon.bending_stiffness * scene.ribbon.width);
  result.energy.kinetic = run.path ? 0 : rod::kinetic_energy(run.rod, run.state);
  result.energy.gravity = rod::gravity_energy(run.rod, scene.surroundings.gravity, run.state);
  result.isometry = geometry::isometry_errors(rod::surface_grid(run.rod, run.state, kAcross));
  result.moved_seconds = run.path ? 0 : run.state.time;
  return run.log.finished();
}

}  // namespace wunderlich::scene
