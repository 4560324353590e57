// One step of the shells, as in the paper's Table 2: the strip of Fig. 8 (l/w = 5 pi/2) under 100 D/w while its end
// turns from pi/2 on, with the paper's meshes and time steps. Counters: milliseconds of the solve of implicit Euler, of
// the lengths, of the boundary and in all, the paper's total (on a processor of 2009), rounds of projection a step, and
// the share of steps whose lengths did not come below 1 % within 50 rounds. The paper names no material; the density is
// such that h^2 D/(rho w^4) is `kStep` whatever the mesh, so that a step is as long for the motion as the next.
#include <benchmark/benchmark.h>

#include <cmath>

#include "wunderlich/baseline/shell/step.hpp"
#include "wunderlich/baseline/shell_conforming/conforming.hpp"
#include "wunderlich/baseline/shell_nonconforming/nonconforming.hpp"

namespace {

using namespace wunderlich;
namespace shell = baseline::shell;

constexpr double kPi = 3.14159265358979323846;
constexpr double kStep = 4e-5;

struct Setup {
  geometry::RibbonSpec strip;
  constraint::Surroundings surroundings;
};

/// A strip whose end turns by 2 pi in `duration`, after a sixth of which the pull is whole.
Setup fig8(double density, double duration) {
  Setup setup;
  setup.strip.width = 1 / (2.5 * kPi);
  setup.strip.segments = 35;
  setup.strip.area_density = density;
  setup.strip.clamped = {true, true};
  const Quat flat(Mat3{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}});
  constraint::Support start, end;
  start.motion.keys = {{0, {Vec3::Zero(), flat}, 0}};
  end.node = 35;
  end.hold_position = {false, true, true};
  end.motion.keys = {{0, {Vec3(1, 0, 0), flat}, 0}, {duration, {Vec3(1, 0, 0), flat}, 2 * kPi}};
  setup.surroundings.supports = {start, end};
  constraint::Load pull;
  pull.node = 35;
  pull.keys = {{0, Vec3(5, 0, 0), Vec3::Zero()}, {duration / 6, Vec3(100 / setup.strip.width, 0, 0), Vec3::Zero()}};
  setup.surroundings.loads = {pull};
  return setup;
}

void bm_step(benchmark::State& bench, bool conforming, int across, int along, double step_ms, double paper_ms) {
  const double h = step_ms * 1e-3, width = 1 / (2.5 * kPi);
  const double density = h * h / (kStep * std::pow(width, 4));
  const int turning = 1200;
  const Setup setup = fig8(density, turning * h);
  const shell::Resolution resolution{along, across};
  const shell::Shell model = conforming ? baseline::shell_conforming::make_shell(setup.strip, resolution)
                                        : baseline::shell_nonconforming::make_shell(setup.strip, resolution);
  shell::State state = shell::straight_state(model, setup.surroundings, 1e-4);
  shell::Work work;
  shell::Options options;
  options.accept_inexact = true;
  options.max_iterations = 50;
  options.damping = 1e-3 / h;
  int k = 0;
  for (; k < turning / 4; ++k) shell::step(model, setup.surroundings, options, (k + 1) * h, state, work);
  shell::StepReport sum;
  int inexact = 0, steps = 0;
  for (auto _ : bench) {
    const shell::StepReport report = shell::step(model, setup.surroundings, options, (++k) * h, state, work);
    sum.sol_seconds += report.sol_seconds;
    sum.length_seconds += report.length_seconds;
    sum.boundary_seconds += report.boundary_seconds;
    sum.other_seconds += report.other_seconds;
    sum.iterations += report.iterations;
    inexact += report.converged ? 0 : 1;
    ++steps;
  }
  const double per = 1e3 / steps;
  bench.counters["t_sol"] = sum.sol_seconds * per;
  bench.counters["t_len"] = sum.length_seconds * per;
  bench.counters["t_bd"] = sum.boundary_seconds * per;
  bench.counters["total"] = (sum.sol_seconds + sum.length_seconds + sum.boundary_seconds + sum.other_seconds) * per;
  bench.counters["paper"] = paper_ms;
  bench.counters["rounds"] = static_cast<double>(sum.iterations) / steps;
  bench.counters["inexact"] = static_cast<double>(inexact) / steps;
}

#define WUNDERLICH_TABLE_2(...) BENCHMARK_CAPTURE(bm_step, __VA_ARGS__)->Unit(benchmark::kMillisecond)->Iterations(300)

WUNDERLICH_TABLE_2(conforming_12x36, true, 12, 36, 0.1, 52.48);
WUNDERLICH_TABLE_2(conforming_4x36, true, 4, 36, 1.0, 15.71);
WUNDERLICH_TABLE_2(nonconforming_8x26, false, 8, 26, 0.1, 66.75);
WUNDERLICH_TABLE_2(nonconforming_4x21, false, 4, 21, 1.0, 20.76);

}  // namespace
