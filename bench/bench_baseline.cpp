// Problem T: a strip of length 1, width 0.1, h = 1e-3, E = 1e9, nu = 0.3, its first and last edge clamped, the ends
// turned by +-pi/2 and brought together by 0.05 in 20 equal load steps; by the rod and by the ribbon.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "wunderlich/baseline/rod/motion.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace {

using namespace wunderlich;
namespace rod = baseline::rod;

constexpr double kPi = 3.14159265358979323846;
constexpr int kSteps = 20;

geometry::RibbonSpec spec_of(int nodes) {
  geometry::RibbonSpec spec;
  spec.segments = nodes - 1;
  spec.bending_stiffness = 1e9 * 1e-9 / (12 * (1 - 0.3 * 0.3));
  return spec;
}

/// The edge is held, by the node nearer to the strip's end.
constraint::Support clamp(int node, int segment, double from, double to, double turn) {
  Mat3 frame;
  frame << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  constraint::Support support;
  support.node = node;
  support.segment = segment;
  support.motion.keys = {{0, {Vec3(from, 0, 0), Quat(frame)}, 0}, {1, {Vec3(to, 0, 0), Quat(frame)}, turn}};
  return support;
}

constraint::Surroundings ends(int nodes) {
  const double l = 1.0 / (nodes - 1);
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, 0, 0, 0.025, -kPi / 2), clamp(nodes - 2, nodes - 2, 1 - l, 0.975 - l, kPi / 2)};
  return surroundings;
}

/// CPU time of this process [s].
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// range(0): nodes, range(1): 0 averaged curvature, 1 separate ones. Counters are of CPU time.
void RodProblemT(benchmark::State& state) {
  const int nodes = static_cast<int>(state.range(0));
  const geometry::RibbonSpec spec = spec_of(nodes);
  rod::Rod strip = rod::make_rod(spec, rod::physical(spec, 0.3, 1e-3));
  strip.bending = state.range(1) == 0 ? rod::Bending::averaged : rod::Bending::separate;
  const constraint::Surroundings surroundings = ends(nodes);
  rod::Workspace work;
  rod::State at;
  int iterations = 0;
  double first = 0, all = 0;
  for (auto _ : state) {
    at = rod::straight_state(strip);
    for (Vec3& x : at.x) x.z() += 1e-4 * std::sin(kPi * x.x());
    iterations = 0;
    const double start = cpu_seconds();
    for (int k = 1; k <= kSteps; ++k) {
      const rod::Report report = rod::equilibrium(strip, surroundings, static_cast<double>(k) / kSteps, {}, at, work);
      iterations += report.iterations;
      if (!report.converged()) state.SkipWithError(rod::outcome_name(report.outcome));
      if (k == 1) first += cpu_seconds() - start;
    }
    all += cpu_seconds() - start;
  }
  const double runs = static_cast<double>(state.iterations());
  state.counters["equilibrium_ms"] = 1e3 * all / runs / kSteps;
  state.counters["buckling_ms"] = 1e3 * first / runs;
  state.counters["iteration_us"] = 1e6 * all / runs / iterations;
  state.counters["iterations"] = iterations;
  state.counters["energy"] = rod::elastic_energy(strip, at).sum();
}

/// range(0): nodes. Counters are of CPU time.
void RibbonProblemT(benchmark::State& state) {
  const int nodes = static_cast<int>(state.range(0));
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec_of(nodes));
  solver::PathOptions options;
  options.steps = kSteps;
  const solver::PathProblem path = solver::make_path(ribbon, ends(nodes), options);
  solver::NewtonWorkspace work;
  solver::PathState at;
  double all = 0;
  int steps = 0;
  for (auto _ : state) {
    at = solver::start_path(path);
    steps = 0;
    const double start = cpu_seconds();
    while (at.phase != solver::Phase::done) {
      const bool load = at.phase == solver::Phase::load;
      const solver::PathStep step = solver::advance(path, at, work);
      steps += load;
      if (step.exhausted) {
        state.SkipWithError(step.failure.c_str());
        return;
      }
    }
    all += cpu_seconds() - start;
  }
  const double runs = static_cast<double>(state.iterations());
  state.counters["equilibrium_ms"] = 1e3 * all / runs / kSteps;
  state.counters["iteration_us"] = 1e6 * all / runs / at.iterations;
  state.counters["iterations"] = at.iterations;
  state.counters["load_steps"] = steps;
  state.counters["energy"] = solver::elastic_energy(ribbon, path.options.model, at.chain);
}

BENCHMARK(RodProblemT)->ArgsProduct({{50, 100, 200}, {0, 1}})->Unit(benchmark::kMillisecond);
BENCHMARK(RibbonProblemT)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

}  // namespace
