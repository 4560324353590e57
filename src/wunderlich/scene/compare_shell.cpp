#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wunderlich/baseline/shell/balance.hpp"
#include "wunderlich/baseline/shell/bending.hpp"
#include "wunderlich/baseline/shell/measure.hpp"
#include "wunderlich/baseline/shell/step.hpp"
#include "wunderlich/baseline/shell_conforming/conforming.hpp"
#include "wunderlich/baseline/shell_nonconforming/nonconforming.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/geometry/isometry.hpp"
#include "wunderlich/scene/compare_models.hpp"
#include "wunderlich/scene/start.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

namespace shell = baseline::shell;

namespace {

constexpr double kBulge = 1e-4;  // over the length: out of its plane, so that a flat strip can buckle
constexpr double kDrift = 2e-3;  // over the length: what points move by, in a quarter of the time of loading, at rest
constexpr double kCreep = 1e-4;  // the same in the implicit metric, which has no jerks
constexpr double kJerk = 1e-6;   // of the elastic energy: what may move at rest
constexpr double kFlat = 1e-9;   // of D w/l: what counts as elastic energy of a shell that ends flat
constexpr double kMaxMissed = 0.5, kMaxOff = 2;  // of the steps; of the tolerance
constexpr int kRounds = 50;                      // of fast projection in a step; where it locks, more do not help

bool conforms(Model model) { return model == Model::shell_conforming; }

shell::Shell shell_of(const Scene& scene, Model model) {
  const CompareOptions::Shell& size = conforms(model) ? scene.compare.conforming : scene.compare.nonconforming;
  const shell::Resolution resolution{size.along, size.across};
  return conforms(model) ? baseline::shell_conforming::make_shell(scene.ribbon, resolution)
                         : baseline::shell_nonconforming::make_shell(scene.ribbon, resolution);
}

geometry::StripGrid grid_of(const shell::Shell& shell, const shell::Points& x) {
  const shell::StripMesh& mesh = shell.mesh;
  const shell::Points vertices = shell::drawn_vertices(shell, x);
  geometry::StripGrid grid{mesh.columns - mesh.ghosts[0] - mesh.ghosts[1] - 1, mesh.across - 1, {}, {}};
  for (int i = mesh.ghosts[0]; i < mesh.columns - mesh.ghosts[1]; ++i) {
    for (int j = 0; j < mesh.across; ++j) {
      const int vertex = mesh.vertex(i, j);
      grid.points.push_back(vertices.row(vertex).transpose());
      grid.flat.push_back(mesh.vertices[static_cast<std::size_t>(vertex)]);
    }
  }
  return grid;
}

/// Where the ribbon starts: its straight strip on its first support for a path, else that of `initial`.
Start ribbon_start(const Scene& scene, const geometry::Ribbon& ribbon) {
  if (scene.solver.method != Method::equilibrium) return start_of(scene, ribbon);
  return {geometry::state_of(ribbon, solver::start_path(solver::make_path(ribbon, scene.surroundings, {})).chain, 0),
          ""};
}

/// The point (u, v) of the ribbon's surface, `lift` [m] above it. Along a row v = const it has its corners on the
/// rulings, at u_k + v eta_k; beyond the ends it goes on straight.   @eq Shen2015:1
Vec3 on_ribbon(const geometry::Ribbon& ribbon, const geometry::State& state, const Vec2& flat, double lift) {
  const auto corner = [&](std::size_t k) { return ribbon.node_u[k] + flat.y() * state.eta[k]; };
  const std::size_t last = state.q.size() - 1;
  std::size_t s = 0;
  while (s < last && corner(s + 1) < flat.x()) ++s;
  const bool before = flat.x() < 0 && ribbon.clamped[0], beyond = flat.x() > ribbon.length && ribbon.clamped[1];
  const Quat& frame = before ? state.end_frame[0] : beyond ? state.end_frame[1] : state.q[s];
  const std::size_t node = beyond ? last + 1 : s;
  return state.r[node] + frame * Vec3(lift, flat.y(), flat.x() - ribbon.node_u[node]);
}

/// One run under way. A path of loads is gone through in time, slowly and damped, and then waited for.
struct ShellRun {
  ShellRun(const Scene& s, Model model, const Observer& observer)
      : scene(s),
        path(s.solver.method == Method::equilibrium),
        factor(path ? s.compare.load_time : 1),
        surroundings(path ? stretched(s.surroundings, factor) : s.surroundings),
        settled(standing_at(surroundings, factor * s.solver.duration)),
        loaded(factor * s.solver.duration),
        time_step(conforms(model) ? s.compare.conforming.time_step : s.compare.nonconforming.time_step),
        shell(shell_of(s, model)),
        log(s, model, loaded + (path ? s.compare.settle_time : 0), factor, observer) {
    options.metric = s.compare.implicit_metric ? shell::Metric::implicit : shell::Metric::mass;
    options.length_tolerance = s.compare.length_tolerance;
    options.max_iterations = kRounds;
    options.accept_inexact = true;  // else a mesh that locks could not be shown at all; it is counted
    options.damping = s.compare.damping;
  }

  const Scene& scene;
  bool path;
  double factor;
  constraint::Surroundings surroundings, settled;  // on the way, and when the path is over and its last loads stay
  double loaded, time_step;                        // when the loads have come [s]
  constraint::Surroundings approach;               // of a path, to its start
  bool approaching = false;
  shell::Shell shell;
  ModelLog log;
  shell::Options options;
  shell::State state;
  shell::Work work;
  long tried = 0, missed = 0;  // steps; those whose lengths stayed off
  double worst = 0;            // of a length, relative
  shell::Points before;        // at the last look whether it rests
  double next_look = 0;        // [s]
  bool rests = false;

  /// Where the ribbon starts. Why not, else empty.
  std::string start() {
    const geometry::Ribbon ribbon = path ? geometry::make_ribbon(scene.ribbon) : motion_ribbon(scene, 0);
    const Start start = ribbon_start(scene, ribbon);
    if (!start.failure.empty()) return start.failure;
    approach = stretched(approach_to(scene.surroundings, own_poses(start.shape)), factor);
    state.x.setZero(shell.point_count(), 3);
    state.v.setZero(shell.point_count(), 3);
    Vec3 center = Vec3::Zero();
    for (int p = 0; p < shell.point_count(); ++p) {
      const Vec2& flat = shell.flat[static_cast<std::size_t>(p)];
      const double u = flat.x() / ribbon.length;
      const double lift = path && u > 0 && u < 1 ? kBulge * ribbon.length * std::sin(3.14159265358979323846 * u) : 0;
      state.x.row(p) = on_ribbon(ribbon, start.shape, flat, lift).transpose();
      center += shell.mass[static_cast<std::size_t>(p)] * state.x.row(p).transpose();
    }
    center /= std::accumulate(shell.mass.begin(), shell.mass.end(), 0.0);
    for (int p = 0; p < shell.point_count() && !path; ++p) {
      const Vec3 arm = state.x.row(p).transpose() - center;
      state.v.row(p) = (scene.initial.velocity + scene.initial.spin.cross(arm)).transpose();
    }
    return {};
  }

  /// Where the strip has its supports at the start.
  std::vector<Pose> own_poses(const geometry::State& shape) const {
    std::vector<Pose> poses;
    for (const constraint::Support& support : scene.surroundings.supports) {
      const auto segment = static_cast<std::size_t>(support.segment >= 0 ? support.segment : support.node);
      poses.push_back(
          {shape.r[static_cast<std::size_t>(support.node)], shape.q[std::min(segment, shape.q.size() - 1)]});
    }
    return poses;
  }

  Tried step_to(double t) {
    const bool over = path && state.time >= loaded - 1e-9 * time_step;
    const constraint::Surroundings& now = approaching ? approach : over ? settled : surroundings;
    const shell::StepReport report = shell::step(shell, now, options, t, state, work);
    ++tried;
    missed += !report.converged;
    worst = std::max(worst, report.max_length_error);
    log.phase("t_sol", report.sol_seconds);
    log.phase("t_len", report.length_seconds);
    log.phase("t_bd", report.boundary_seconds);
    return {report.iterations, report.accepted ? "" : report.failure};
  }

  /// Has nothing gone anywhere since the last look? In the metric of masses speeds would not tell: lengths that may be
  /// off by the tolerance are put right by jerks, for ever.
  bool is_over() {
    if (!path || state.time < loaded || state.time < next_look) return false;
    const bool implicit = options.metric == shell::Metric::implicit;
    const double drift = (implicit ? kCreep : kDrift) * scene.ribbon.length;
    const geometry::RibbonSpec& strip = scene.ribbon;
    const double least = kFlat * strip.bending_stiffness * strip.width / strip.length;  // rounding leaves less than 0
    const double elastic = std::max(shell::bending_energy(shell, state.x), least);
    const bool slow = !implicit || shell::kinetic_energy(shell, state.v) <= kJerk * elastic;
    const bool still = slow && before.size() > 0 && (state.x - before).rowwise().norm().maxCoeff() < drift;
    before = state.x;
    next_look = state.time + 0.25 * factor;
    rests = still;
    return rests;
  }

  Mesh surface() const { return shell::surface_mesh(shell, state.x); }

  void go() {
    const Stepped stepped{[this](double t) { return step_to(t); }, [this] { return is_over(); },
                          [this] { return surface(); }};
    log.frame(0, surface());
    approaching = path && is_away(approach, scene.ribbon.length);
    if (approaching && !log.approach(stepped, factor, steps_of(factor, time_step))) return;
    if (approaching) state.time = 0;
    approaching = false;
    if (log.run(stepped, time_step) && path && !rests) log.result().failure = "not at rest after compare.settle_time";
  }

  double missed_share() const { return tried > 0 ? static_cast<double>(missed) / static_cast<double>(tried) : 0; }

  /// A state whose lengths are off is none of an inextensible strip.
  void judge_lengths() {
    std::string& failure = log.result().failure;
    if (!failure.empty()) return;
    const double off = shell::length_error(shell, state.x);
    if (off > kMaxOff * options.length_tolerance)
      failure = fmt::format("lengths are off by {:.2g} % at the end", 100 * off);
    if (missed_share() > kMaxMissed)
      failure = fmt::format("lengths stayed off in {:.0f} % of the steps", 100 * missed_share());
  }
};

/// Why its mesh is too coarse for the supports, else empty.
std::string overlap(const shell::Shell& shell, const Scene& scene, Model model) {
  const std::string reason = shell::overlapping(shell, scene.surroundings);
  if (reason.empty()) return reason;
  return fmt::format("{}: choose compare.{}.along and across so that each has its own", reason,
                     conforms(model) ? "shell_conforming" : "shell_nonconforming");
}

void add_notes(const ShellRun& run, std::vector<std::string>& notes) {
  const Scene& scene = run.scene;
  if (const double shift = shell::largest_shift(run.shell, scene.surroundings); shift > 1e-9 * scene.ribbon.length)
    notes.push_back(fmt::format("pins or loads stand up to {:.2g} m from their places on the strip", shift));
  if (run.missed > 0) {
    notes.push_back(fmt::format("in {:.1f} % of the steps lengths stayed off by more than {:g} %, at most by {:.2g} %",
                                100 * run.missed_share(), 100 * scene.compare.length_tolerance, 100 * run.worst));
  }
  if (run.path && !scene.compare.implicit_metric)
    notes.push_back("at rest in the metric of masses, which is no equilibrium and depends on the time step");
}

}  // namespace

ModelResult run_shell(const Scene& scene, Model model, const Observer& observer) {
  ShellRun run(scene, model, observer);
  ModelResult& result = run.log.result();
  const CompareOptions::Shell& size = conforms(model) ? scene.compare.conforming : scene.compare.nonconforming;
  result.method = "implicit-euler";
  result.resolution = fmt::format("{} x {} vertices", size.along, size.across);
  result.unknowns = shell::degrees_of_freedom(run.shell);
  result.constraints = shell::constraint_count(run.shell);
  result.failure = shell::unsupported(scene.ribbon, scene.surroundings);
  if (result.failure.empty()) result.failure = overlap(run.shell, scene, model);
  if (result.failure.empty()) result.failure = run.start();
  if (result.failure.empty()) run.go();
  run.judge_lengths();
  result.converged = result.failure.empty();
  add_notes(run, result.notes);
  if (result.frames.empty()) {
    run.state = shell::straight_state(run.shell, run.surroundings);
    run.log.frame(0, run.surface());
  }
  result.energy.elastic = shell::bending_energy(run.shell, run.state.x);
  result.energy.kinetic = shell::kinetic_energy(run.shell, run.state.v);
  result.energy.gravity = shell::gravity_energy(run.shell, scene.surroundings.gravity, run.state.x);
  result.length_error = shell::length_error(run.shell, run.state.x);
  result.missed_steps = run.missed_share();
  result.isometry = geometry::isometry_errors(grid_of(run.shell, run.state.x));
  result.moved_seconds = run.state.time;
  if (run.path && run.rests && scene.surroundings.obstacles.empty())
    result.imbalance = shell::net_force(run.shell, run.settled, run.state);
  return run.log.finished();
}

}  // namespace wunderlich::scene
