// Cost of one Newton iteration and of its parts, per node, as n grows: it must be linear.
// Counter: seconds per node of the timed part (200n is 200 ns).
#include <benchmark/benchmark.h>

#include <cmath>

#include "wunderlich/solver/chain_objective.hpp"
#include "wunderlich/solver/newton.hpp"

namespace {

using namespace wunderlich;

enum class Ends { free, clamped, loop };

/// A bent, twisted strip with all terms of a static problem: what an iteration meets in practice.
struct Setup {
  geometry::Ribbon ribbon;
  solver::ChainProblem problem;
  geometry::Chain chain;
  std::vector<double> multipliers;
  solver::NewtonWorkspace work;

  Setup(int segments, Ends ends) {
    geometry::RibbonSpec spec;
    spec.segments = segments;
    spec.clamped = {true, ends == Ends::clamped};
    if (ends == Ends::loop) spec.closure = geometry::Closure::loop, spec.half_twists = 1;
    ribbon = geometry::make_ribbon(spec);
    chain = geometry::straight_chain(ribbon, Pose{});
    for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
      const double u = ribbon.node_u[i];
      if (geometry::kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = 3 + 2 * std::sin(9 * u);
      if (geometry::eta_is_free(ribbon, static_cast<int>(i))) chain.eta[i] = 0.5 * std::sin(6.283185307179586 * u);
    }
    problem.force.assign(chain.kappa.size(), Vec3(0, 0, -1.0 / segments));
    problem.base_fixed.fill(true);
    problem.closed = ends == Ends::loop;
    geometry::forward_kinematics(ribbon, chain, work.kinematics);
    if (ends == Ends::clamped) {
      solver::Hold hold;
      hold.node = segments;
      hold.target = {work.kinematics.r.back(), work.kinematics.q.back()};
      problem.holds = {hold};
    }
    multipliers.assign(solver::row_count(problem), 0.1);
    linearise();
  }
  void kinematics() { geometry::forward_kinematics(ribbon, chain, work.kinematics); }
  void linearise() { solver::linearise(ribbon, problem, chain, work.kinematics, multipliers, {}, work.system); }
  bool sweep() { return math::chain_step(work.system, work.sweep, work.step); }
};

template <class Part>
void measure(benchmark::State& state, Ends ends, const Part& part) {
  Setup setup(static_cast<int>(state.range(0)), ends);
  for (auto _ : state) {
    part(setup);
    benchmark::ClobberMemory();
  }
  state.counters["s_per_node"] = benchmark::Counter(
      static_cast<double>(state.range(0)), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetComplexityN(state.range(0));
}

void iteration(Setup& s) {
  s.kinematics();
  s.linearise();
  benchmark::DoNotOptimize(s.sweep());
}

void IterationFreeEnd(benchmark::State& state) { measure(state, Ends::free, iteration); }
void IterationClampedEnd(benchmark::State& state) { measure(state, Ends::clamped, iteration); }
void IterationLoop(benchmark::State& state) { measure(state, Ends::loop, iteration); }
void PartKinematics(benchmark::State& state) {
  measure(state, Ends::free, [](Setup& s) { s.kinematics(); });
}
void PartDerivatives(benchmark::State& state) {
  measure(state, Ends::free, [](Setup& s) { s.linearise(); });
}
void PartSweepsFreeEnd(benchmark::State& state) {
  measure(state, Ends::free, [](Setup& s) { benchmark::DoNotOptimize(s.sweep()); });
}
void PartSweepsClampedEnd(benchmark::State& state) {
  measure(state, Ends::clamped, [](Setup& s) { benchmark::DoNotOptimize(s.sweep()); });
}
void PartObjective(benchmark::State& state) {
  measure(state, Ends::free, [](Setup& s) {
    benchmark::DoNotOptimize(
        solver::objective(s.ribbon, s.problem, s.chain, s.work.kinematics, s.work.kinematics).total());
  });
}

/// How fast this machine is, to hold the figures against: a chain of multiplications, each waiting for the one before
/// (four cycles on most processors of today). Counter: seconds each.
void MachineMultiplyChain(benchmark::State& state) {
  double x = 1;
  for (auto _ : state) {
    for (int i = 0; i < 1000; ++i) x *= 1.0000001;
    benchmark::DoNotOptimize(x);
    x = 1;
  }
  state.counters["s_each"] =
      benchmark::Counter(1000, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK(MachineMultiplyChain);
BENCHMARK(IterationFreeEnd)->RangeMultiplier(2)->Range(50, 6400)->Complexity(benchmark::oN);
BENCHMARK(IterationClampedEnd)->RangeMultiplier(2)->Range(50, 6400)->Complexity(benchmark::oN);
BENCHMARK(IterationLoop)->RangeMultiplier(2)->Range(50, 6400)->Complexity(benchmark::oN);
BENCHMARK(PartKinematics)->Arg(50)->Arg(400);
BENCHMARK(PartDerivatives)->Arg(50)->Arg(400);
BENCHMARK(PartSweepsFreeEnd)->Arg(50)->Arg(400);
BENCHMARK(PartSweepsClampedEnd)->Arg(50)->Arg(400);
BENCHMARK(PartObjective)->Arg(50)->Arg(400);

}  // namespace
