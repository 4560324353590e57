// Solver time from a flat strip to the Möbius band at rest, with the share of each phase.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <map>

#include "wunderlich/solver/equilibrium.hpp"

namespace {

using namespace wunderlich;

/// range(0): segments, range(1): 100 l / (pi w). Counters: milliseconds by phase, iterations, V l / (D w).
void FlatToMoebius(benchmark::State& state) {
  geometry::RibbonSpec spec;
  spec.segments = static_cast<int>(state.range(0));
  spec.width = 100 / (3.14159265358979323846 * static_cast<double>(state.range(1)));
  spec.closure = geometry::Closure::loop;
  spec.half_twists = 1;
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  const solver::PathProblem path = solver::make_path(ribbon, {}, {});
  std::map<solver::Phase, double> seconds;
  solver::PathState at;
  for (auto _ : state) {
    solver::NewtonWorkspace work;
    at = solver::start_path(path);
    while (at.phase != solver::Phase::done) {
      const solver::Phase phase = at.phase;
      const auto start = std::chrono::steady_clock::now();
      if (solver::advance(path, at, work).exhausted) {
        state.SkipWithError("did not converge");
        return;
      }
      seconds[phase] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  }
  for (const auto& [phase, sum] : seconds) {
    state.counters[std::string(solver::phase_name(phase)) + "_ms"] =
        1e3 * sum / static_cast<double>(state.iterations());
  }
  state.counters["iterations"] = at.iterations;
  state.counters["energy"] =
      solver::elastic_energy(ribbon, path.options.model, at.chain) * ribbon.length / ribbon.width;
}

BENCHMARK(FlatToMoebius)->ArgsProduct({{50, 100, 200, 400}, {1000, 500, 250, 125}})->Unit(benchmark::kMillisecond);

}  // namespace
