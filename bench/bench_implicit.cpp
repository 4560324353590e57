// Implicit dynamics: the time of a step, of an iteration per node as n grows, of an iteration's parts, and how much of
// what this machine can do the sweep gets. Counters in seconds (40u is 40 us) or operations per second.
// For figures that can be compared: --benchmark_enable_random_interleaving=true --benchmark_repetitions=7, and minima.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "wunderlich/math/four.hpp"
#include "wunderlich/solver/implicit/implicit.hpp"

namespace {

using namespace wunderlich;
namespace implicit = solver::implicit;
using benchmark::Counter;
using implicit::Integrator;
using implicit::KineticEnergy;
using math::Four;

constexpr double kStep = 5e-3;  // s

/// A strip clamped level along +x at its start.
struct Strip {
  double length, width, bending_stiffness, area_density;
  Vec3 gravity;
};

/// The scene `swing`: stiff, smooth, out of its plane.
Strip swing() { return {1, 0.1, 1, 1, {0, 1.4776, -4.7767}}; }

/// A sheet as soft as cloth: it falls, folds and whips.
Strip soft_sheet() { return {0.3, 0.03, 2.7e-4, 0.1, {0, 9.81 * std::sin(0.3), -9.81 * std::cos(0.3)}}; }

solver::PathProblem path_of(const Strip& strip, int segments) {
  geometry::RibbonSpec spec;
  spec.length = strip.length;
  spec.width = strip.width;
  spec.segments = segments;
  spec.bending_stiffness = strip.bending_stiffness;
  spec.area_density = strip.area_density;
  spec.clamped = {true, false};
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  constraint::Support clamp;
  clamp.motion.keys = {{0, {Vec3::Zero(), geometry::straight_state(ribbon).q.front()}, 0}};
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp};
  surroundings.gravity = strip.gravity;
  solver::PathOptions options;
  options.barrier = 1e-3;  // as in scenes
  return solver::make_path(ribbon, surroundings, options);
}

/// A motion under way, let go from straight.
struct Motion {
  solver::PathProblem path;
  implicit::Options options;
  implicit::Workspace work;
  implicit::State state;
  long iterations = 0, divided = 0;

  Motion(const Strip& strip, int segments, KineticEnergy kinetic, Integrator integrator)
      : path(path_of(strip, segments)) {
    options.kinetic = kinetic;
    options.integrator = integrator;
    restart();
  }

  void restart() { state = implicit::start(path, options, geometry::straight_state(path.ribbon), Vec3::Zero(), work); }

  /// Halves steps that fail.
  void advance(double t1, int halvings = 0) {
    const implicit::StepReport report = implicit::step(path, options, t1, halvings, state, work);
    iterations += report.iterations;
    if (report.accepted) return;
    ++divided;
    if (halvings == 10) std::abort();
    advance(state.strips[0].path.t + 0.5 * (t1 - state.strips[0].path.t), halvings + 1);
    advance(t1, halvings + 1);
  }

  void advance_by(int steps) {
    const double t0 = state.strips[0].path.t;
    for (int i = 1; i <= steps; ++i) advance(t0 + i * kStep);
  }
};

Counter seconds_each(double count) { return {count, Counter::kIsIterationInvariantRate | Counter::kInvert}; }
Counter rate(double count) { return {count, Counter::kIsIterationInvariantRate}; }

KineticEnergy kinetic_of(const benchmark::State& state) { return static_cast<KineticEnergy>(state.range(0)); }

/// The motion's first `steps` steps, over and over.
void measure_steps(benchmark::State& state, const Strip& strip, int steps) {
  Motion motion(strip, 50, kinetic_of(state), static_cast<Integrator>(state.range(1)));
  for (auto _ : state) {
    state.PauseTiming();
    motion.restart();
    state.ResumeTiming();
    motion.advance_by(steps);
  }
  const double runs = static_cast<double>(state.iterations()) * steps;
  state.counters["s_per_step"] = seconds_each(steps);
  state.counters["iterations"] = static_cast<double>(motion.iterations) / runs;
  state.counters["divided"] = static_cast<double>(motion.divided) / runs;
}

void StepSmooth(benchmark::State& state) { measure_steps(state, swing(), 200); }
void StepViolent(benchmark::State& state) { measure_steps(state, soft_sheet(), 100); }

/// Whole steps of the swing, per node and iteration.
void IterationPerNode(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(1));
  Motion motion(swing(), n, kinetic_of(state), Integrator::generalised_alpha);
  motion.advance_by(10);
  const implicit::State begin = motion.state;
  motion.iterations = 0;
  constexpr int kSteps = 10;
  for (auto _ : state) {
    motion.state = begin;
    motion.advance_by(kSteps);
  }
  const double each = static_cast<double>(motion.iterations) / static_cast<double>(state.iterations());
  state.counters["s_per_node"] = seconds_each(each * n);
  state.counters["iterations"] = each / kSteps;
}

/// The problem of one step, at the state it ended in.
struct Parts {
  Motion motion;
  solver::ChainProblem problem;
  solver::NewtonWorkspace work;
  geometry::Chain chain;
  std::vector<double> multipliers;

  Parts(int segments, KineticEnergy kinetic) : motion(swing(), segments, kinetic, Integrator::generalised_alpha) {
    motion.advance_by(10);
    problem = motion.work.strips[0].problem;
    chain = motion.state.strips[0].path.chain;
    multipliers = motion.state.strips[0].path.multipliers;
    kinematics();
    linearise();
    if (!sweep()) std::abort();
  }
  const geometry::Ribbon& ribbon() const { return motion.path.ribbon; }
  void kinematics() { geometry::forward_kinematics(ribbon(), chain, work.kinematics); }
  void linearise() { solver::linearise(ribbon(), problem, chain, work.kinematics, multipliers, {}, work.system); }
  bool sweep() { return math::chain_step(work.system, work.sweep, work.step); }
  double objective() const {
    return solver::objective(ribbon(), problem, chain, work.kinematics, work.kinematics).total();
  }
};

template <class Part>
void measure_part(benchmark::State& state, const Part& part) {
  Parts parts(static_cast<int>(state.range(1)), kinetic_of(state));
  for (auto _ : state) {
    part(parts);
    benchmark::ClobberMemory();
  }
  state.counters["s_per_node"] = seconds_each(static_cast<double>(state.range(1)));
}

void PartKinematics(benchmark::State& state) {
  measure_part(state, [](Parts& p) { p.kinematics(); });
}
void PartDerivatives(benchmark::State& state) {
  measure_part(state, [](Parts& p) { p.linearise(); });
}
void PartObjective(benchmark::State& state) {
  measure_part(state, [](Parts& p) { benchmark::DoNotOptimize(p.objective()); });
}

/// Additions and multiplications of a sweep without constraint rows, per node, counted in the source; lanes whose
/// result is not used do not count, a division counts as one. Backward: node 12, joint 168 (rows u of the Hessian 84,
/// 2 x 2 block 30, gradient 12, geometric terms 42), elimination 264 (pivot 20, gains 42, reduction of the pose block
/// 132, coupling to the joint before 70), span 206 (congruence 144, geometric terms 50, torque 12). Forward: 58.
constexpr double kSweepFlops = 12 + 168 + 264 + 206 + 58;
/// A facet adds a full 6 x 6 block with its gradient, and its geometric 3 x 3 block.
constexpr double kFacetFlops = 54;

void PartSweeps(benchmark::State& state) {
  measure_part(state, [](Parts& p) { benchmark::DoNotOptimize(p.sweep()); });
  const double flops = kSweepFlops + (kinetic_of(state) == KineticEnergy::centerline ? 0 : kFacetFlops);
  state.counters["flops"] = rate(flops * static_cast<double>(state.range(1)));
}

using Mat8 = Eigen::Matrix<double, 8, 8, Eigen::RowMajor>;
constexpr double kProductFlops = 2 * 8 * 8 * 8;

/// c = a b, rows as two vectors of four.
void product_of_fours(const Four* a, const Four* b, Four* c) {
  for (int i = 0; i < 8; i += 2) {
    Four x0 = math::all(0), x1 = x0, y0 = x0, y1 = x0;
    const auto* p = reinterpret_cast<const double*>(a + 2 * i);
    for (int k = 0; k < 8; ++k) {
      x0 += math::all(p[k]) * b[2 * k];
      x1 += math::all(p[k]) * b[2 * k + 1];
      y0 += math::all(p[8 + k]) * b[2 * k];
      y1 += math::all(p[8 + k]) * b[2 * k + 1];
    }
    c[2 * i] = x0;
    c[2 * i + 1] = x1;
    c[2 * i + 2] = y0;
    c[2 * i + 3] = y1;
  }
}

constexpr int kProducts = 32;

/// What the machine can do on small dense blocks: independent products of 8 x 8, ...
void MachineProductsFour(benchmark::State& state) {
  struct Block {
    Four rows[16];
  };
  std::vector<Block> a(kProducts), c(kProducts);
  for (Block& block : a) std::fill(std::begin(block.rows), std::end(block.rows), math::all(0.1));
  for (auto _ : state) {
    for (int i = 0; i < kProducts; ++i) {
      const auto k = static_cast<std::size_t>(i);
      product_of_fours(a[k].rows, a[(k + 1) % kProducts].rows, c[k].rows);
    }
    benchmark::ClobberMemory();
  }
  state.counters["flops"] = rate(kProducts * kProductFlops);
}

/// ... the same by Eigen, ...
void MachineProductsEigen(benchmark::State& state) {
  std::vector<Mat8> a(kProducts, Mat8::Constant(0.1)), c(kProducts);
  for (auto _ : state) {
    for (int i = 0; i < kProducts; ++i) {
      const auto k = static_cast<std::size_t>(i);
      c[k].noalias() = a[k] * a[(k + 1) % kProducts];
    }
    benchmark::ClobberMemory();
  }
  state.counters["flops"] = rate(kProducts * kProductFlops);
}

/// ... and each waiting for the one before, as the steps of a recursion do.
void MachineProductChain(benchmark::State& state) {
  Four a[16], x[16], y[16];
  std::fill(std::begin(a), std::end(a), math::all(0.125));
  std::fill(std::begin(x), std::end(x), math::all(1));
  for (auto _ : state) {
    for (int i = 0; i < kProducts; i += 2) {
      product_of_fours(x, a, y);
      product_of_fours(y, a, x);
    }
    benchmark::DoNotOptimize(x[0]);
    benchmark::ClobberMemory();
  }
  state.counters["flops"] = rate(kProducts * kProductFlops);
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Others use the machine too: the best of all repetitions says most (for a rate the largest).
void best(benchmark::internal::Benchmark* benchmark) {
  benchmark->ComputeStatistics("min", least)->ComputeStatistics("max", most);
}

// Arguments: kinetic energy (0 centerline, 1 rotary, 2 full), then integrator (0 Euler, 1 BDF2, 2 generalised-alpha)
// or segments.
BENCHMARK(StepSmooth)->ArgsProduct({{0, 1, 2}, {0, 1, 2}})->Unit(benchmark::kMillisecond)->Apply(best);
BENCHMARK(StepViolent)->ArgsProduct({{0, 1, 2}, {2}})->Unit(benchmark::kMillisecond)->Apply(best);
BENCHMARK(IterationPerNode)
    ->ArgsProduct({{0, 1}, {50, 100, 200, 400, 800, 1600, 3200, 6400}})
    ->Unit(benchmark::kMillisecond)
    ->Apply(best);
BENCHMARK(PartKinematics)->ArgsProduct({{0, 1}, {50, 400, 6400}})->Apply(best);
BENCHMARK(PartDerivatives)->ArgsProduct({{0, 1}, {50, 400, 6400}})->Apply(best);
BENCHMARK(PartSweeps)->ArgsProduct({{0, 1}, {50, 400, 6400}})->Apply(best);
BENCHMARK(PartObjective)->ArgsProduct({{0, 1}, {50, 400, 6400}})->Apply(best);
BENCHMARK(MachineProductsFour)->Apply(best);
BENCHMARK(MachineProductsEigen)->Apply(best);
BENCHMARK(MachineProductChain)->Apply(best);

}  // namespace
