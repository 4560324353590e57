#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/baseline/shell/bending.hpp"
#include "wunderlich/baseline/shell/measure.hpp"
#include "wunderlich/baseline/shell/step.hpp"
#include "wunderlich/baseline/shell_conforming/conforming.hpp"
#include "wunderlich/baseline/shell_nonconforming/nonconforming.hpp"
#include "wunderlich/geometry/isometry.hpp"
#include "wunderlich/scene/compare_models.hpp"
#include "wunderlich/scene/start.hpp"

namespace wunderlich::scene {

namespace shell = baseline::shell;

namespace {

constexpr double kBulge = 1e-4;  // over the length: out of its plane, so that a flat strip can buckle
constexpr double kDrift = 2e-3;  // over the length: what points move by, in a quarter of the time of loading, at rest
constexpr int kMaxHalvings = 6;
constexpr int kRounds = 50;  // of fast projection in a step; where it locks, more do not help

bool conforms(Model model) { return model == Model::shell_conforming; }

shell::Shell shell_of(const Scene& scene, Model model) {
  const CompareOptions::Shell& size = conforms(model) ? scene.compare.conforming : scene.compare.nonconforming;
  const shell::Resolution resolution{size.along, size.across, shell::Diagonals::alternate};
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

/// One run under way. A path of loads is gone through in time, slowly and damped, and then waited for.
struct Run {
  Run(const Scene& s, Model model, const Observer& observer)
      : scene(s),
        path(s.solver.method == Method::equilibrium),
        factor(path ? s.compare.load_time : 1),
        surroundings(path ? stretched(s.surroundings, factor) : s.surroundings),
        loaded(factor * s.solver.duration),
        until(loaded + (path ? s.compare.settle_time : 0)),
        time_step(conforms(model) ? s.compare.conforming.time_step : s.compare.nonconforming.time_step),
        failure(shell::unsupported(s.ribbon, s.surroundings)),
        shell(shell_of(s, model)),
        log(s, model, until, observer) {
    options.length_tolerance = s.compare.length_tolerance;
    options.max_iterations = kRounds;
    options.accept_inexact = true;  // else a mesh that locks could not be shown at all; it is counted
    options.damping = s.compare.damping;
  }

  const Scene& scene;
  bool path;
  double factor;
  constraint::Surroundings surroundings;
  double loaded, until, time_step;  // when the loads have come, when it must rest [s]
  std::string failure;
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

  void start() {
    if (!path && scene.initial.shape != InitialShape::straight) failure = "the shells start straight only";
    state = shell::straight_state(shell, surroundings, path ? kBulge * scene.ribbon.length : 0);
    for (Eigen::Index i = 0; i < state.v.rows(); ++i) state.v.row(i) += scene.initial.velocity.transpose();
  }

  bool advance(double t1, int halvings, int& iterations) {
    const double t0 = state.time;
    const shell::StepReport report = shell::step(shell, surroundings, options, t1, state, work);
    iterations += report.iterations;
    ++tried;
    missed += !report.converged;
    worst = std::max(worst, report.max_length_error);
    log.phase("t_sol", report.sol_seconds);
    log.phase("t_len", report.length_seconds);
    log.phase("t_bd", report.boundary_seconds);
    if (report.accepted) return true;
    if (halvings == kMaxHalvings) {
      failure = fmt::format("{} (at {:.3g} s)", report.failure, t1);
      return false;
    }
    return advance(0.5 * (t0 + t1), halvings + 1, iterations) && advance(t1, halvings + 1, iterations);
  }

  /// Has nothing gone anywhere since the last look? Speeds would not tell: lengths that may be off by the tolerance are
  /// put right by jerks, for ever.
  bool is_resting() {
    if (!path || state.time < loaded || state.time < next_look) return false;
    const bool still =
        before.size() > 0 && (state.x - before).rowwise().norm().maxCoeff() < kDrift * scene.ribbon.length;
    before = state.x;
    next_look = state.time + 0.25 * factor;
    return still;
  }

  bool go() {
    const long steps = std::lround(std::ceil(until / time_step - 1e-9));
    log.frame(0, shell::surface_mesh(shell, state.x));
    for (long k = 1; k <= steps; ++k) {
      const double t = k == steps ? until : static_cast<double>(k) * time_step;
      const Stopwatch watch;
      int iterations = 0;
      if (!advance(t, 0, iterations)) return false;
      if (!log.step(t, watch.seconds(), iterations)) return false;
      rests = is_resting();
      const bool over = k == steps || rests;
      if (over || log.wants_frame(t)) log.frame(t / factor, shell::surface_mesh(shell, state.x));
      if (over) break;
    }
    if (path && !rests) failure = "not at rest after compare.settle_time";
    return failure.empty();
  }
};

}  // namespace

ModelResult run_shell(const Scene& scene, Model model, const Observer& observer) {
  Run run(scene, model, observer);
  ModelResult& result = run.log.result();
  const CompareOptions::Shell& size = conforms(model) ? scene.compare.conforming : scene.compare.nonconforming;
  result.method = "implicit-euler";
  result.resolution = fmt::format("{} x {} vertices", size.along, size.across);
  result.unknowns = shell::degrees_of_freedom(run.shell);
  result.constraints = shell::constraint_count(run.shell);
  if (run.failure.empty()) run.start();
  if (run.failure.empty()) result.converged = run.go();
  if (result.failure.empty()) result.failure = run.failure;
  if (run.missed > 0) {
    result.notes.push_back(
        fmt::format("in {:.1f} % of the steps lengths stayed off by more than {:g} %, at most by {:.2g} %",
                    100.0 * static_cast<double>(run.missed) / static_cast<double>(run.tried),
                    100 * scene.compare.length_tolerance, 100 * run.worst));
  }
  if (result.frames.empty()) {
    run.state = shell::straight_state(run.shell, run.surroundings);
    run.log.frame(0, shell::surface_mesh(run.shell, run.state.x));
  }
  result.energy.elastic = shell::bending_energy(run.shell, run.state.x);
  result.energy.normalized =
      result.energy.elastic * scene.ribbon.length / (scene.ribbon.bending_stiffness * scene.ribbon.width);
  result.energy.kinetic = shell::kinetic_energy(run.shell, run.state.v);
  result.isometry = geometry::isometry_errors(grid_of(run.shell, run.state.x));
  result.moved_seconds = run.state.time;
  return run.log.finished();
}

}  // namespace wunderlich::scene
