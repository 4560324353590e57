#include "wunderlich/scene/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "wunderlich/base/error.hpp"
#include "wunderlich/geometry/isometry.hpp"
#include "wunderlich/scene/compare_models.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

constexpr std::array<const char*, 4> names{"ribbon", "rod", "shell-conforming", "shell-nonconforming"};

/// Scalars that the ribbon's method solves for, and the equations between them.
void count_ribbon(const Scene& scene, ModelResult& result) {
  const int n = scene.ribbon.segments;
  if (scene.solver.method == Method::two_stage) {
    result.unknowns = 3 * (n + 1) + 3 * n + (n + 1);  // positions, turns of frames, rulings   @eq Shen2015:7
    result.constraints = 4 * n;  // length, binormal, torsion match, ruling bound   @eq Shen2015:6.6
    return;
  }
  result.unknowns = 2 * n + 6;  // curvature and ruling of each hinge, and the first pose
}

/// The clock of a path runs on while supports are approached and while it settles; other models know the load
/// parameter.
double load_at(const Scene& scene, double clock, double last) {
  const double duration = scene.solver.duration;
  if (scene.ribbon.closure == geometry::Closure::loop) return duration * clock / last;
  return std::clamp(clock - (last - duration - solver::kSettleTime), 0.0, duration);
}

ModelResult run_ribbon(const Scene& scene, const Observer& observer) {
  const RunResult run = scene::run(scene, observer);
  ModelResult result;
  result.model = model_name(Model::ribbon);
  result.method = run.summary.method;
  result.resolution = fmt::format("{} segments", scene.ribbon.segments);
  result.converged = run.summary.converged;
  result.failure = run.outcome == Outcome::interrupted ? kInterrupted : run.summary.failure;
  count_ribbon(scene, result);
  result.energy = run.summary.energy;
  if (run.summary.imbalance) result.imbalance = *run.summary.imbalance / scene.ribbon.bending_stiffness;
  const geometry::State& last = run.progress.records.back().states.front();
  const bool path = scene.solver.method == Method::equilibrium;
  const geometry::Ribbon ribbon = path ? path_ribbon(scene, last) : motion_ribbon(scene, last.time);
  result.isometry = geometry::isometry_errors(geometry::facet_grid(ribbon, last, kAcross));
  result.steps = run.summary.steps;
  result.step_us = run.summary.timing.step_us_median;
  result.iterations = run.summary.timing.iterations_mean;
  result.wall_seconds = run.summary.timing.wall_seconds;
  result.moved_seconds = path ? 0 : last.time;
  for (const Record& record : run.progress.records) {
    result.frames.push_back(frame_of(scene, record));
    if (path && last.time > 0) result.frames.back().time = load_at(scene, result.frames.back().time, last.time);
  }
  return result;
}

}  // namespace

const char* model_name(Model model) { return names[static_cast<std::size_t>(model)]; }

std::vector<Model> parse_models(const std::string& list) {
  std::vector<Model> models;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string word = list.substr(begin, end - begin);
    begin = end + 1;
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) {
      const std::string guess = nearest(word, {names.begin(), names.end()});
      throw InputError(fmt::format("--models: {} is no model{}; must be some of {}, separated by commas", shown(word),
                                   guess.empty() ? "" : fmt::format(" (did you mean `{}`?)", guess),
                                   joined({names.begin(), names.end()})));
    }
    const auto model = static_cast<Model>(found - names.begin());
    if (std::find(models.begin(), models.end(), model) != models.end()) {
      throw InputError(fmt::format("--models: `{}` stands there twice", word));
    }
    models.push_back(model);
  }
  return models;
}

ModelResult run_model(const Scene& scene, Model model, const Observer& observer) {
  const Observer named = [&](const RunStatus& status) {
    return !observer || observer({model_name(model), status.fraction, status.iterations});
  };
  switch (model) {
    case Model::ribbon:
      return run_ribbon(scene, named);
    case Model::rod:
      return run_rod(scene, named);
    case Model::shell_conforming:
    case Model::shell_nonconforming:
      break;
  }
  return run_shell(scene, model, named);
}

void check_comparable(const Scene& scene) {
  if (!scene.beside.empty())
    throw InputError(scene.name + ": models are compared on one strip; this scene has several");
}

Comparison compare(const Scene& scene, const std::vector<Model>& models, const Observer& observer) {
  Comparison comparison{scene.name, scene.title, scene.resolved, {}, {}};
  for (const Model model : models) {
    comparison.models.push_back(run_model(scene, model, observer));
    const ModelResult& result = comparison.models.back();
    std::vector<double> times;
    for (const Frame& frame : result.frames) times.push_back(frame.time);
    comparison.bodies.push_back(bodies_of(scene, times));
    if (result.failure == kInterrupted) break;
  }
  return comparison;
}

}  // namespace wunderlich::scene
