// One iteration of Algorithm 1, as in the paper's Table 1: its scenes with its segments and time steps, in material
// soft enough for that step (the density is raised until the stability bound is 1.1 of it), for each way of stage opt.
// Counters: milliseconds of opt, ode, contact, other and in all, the paper's total (on a processor of 2009), and their
// ratio. A second table grows the number of segments.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/equilibrium.hpp"
#include "wunderlich/solver/two_stage/two_stage.hpp"

namespace {

using namespace wunderlich;
namespace two_stage = solver::two_stage;

constexpr double kPi = 3.14159265358979323846;

enum class Way { newton, lbfgs_direct, printed };

/// A scene of Table 1, at rest but for gravity.
struct Setup {
  geometry::Ribbon ribbon;
  geometry::State shape;
  two_stage::Drive drive;
  two_stage::Options options;
  double dt;
  constraint::Surroundings surroundings;  ///< of a strip that feels itself
};

geometry::State at_rest(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings) {
  solver::PathOptions options;
  if (surroundings.contact.self) options.loop_path = solver::LoopPath::twist;
  const solver::PathProblem path = solver::make_path(ribbon, surroundings, options);
  solver::PathState state = solver::start_path(path);
  solver::NewtonWorkspace work;
  while (state.phase != solver::Phase::done) {
    if (solver::advance(path, state, work).exhausted) std::abort();
  }
  return geometry::state_of(ribbon, state.chain, 0);
}

two_stage::Options options_of(Way way, double step_size) {
  if (way == Way::printed) {
    two_stage::Options options = two_stage::printed_options();
    options.opt.step_size = step_size;
    options.opt.accept_inexact = true;
    return options;
  }
  two_stage::Options options;
  if (way == Way::lbfgs_direct) {
    options.opt.minimiser = two_stage::Minimiser::lbfgs;
    options.opt.accept_inexact = true;
  }
  options.ode.damping_normal = options.ode.damping_tangent = 1;
  return options;
}

/// The density for which 1.1 dt is the bound.
void soften(geometry::RibbonSpec& spec, const two_stage::Options& options, double dt) {
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  const double weight = two_stage::rest_parallel_weight(ribbon, options.ode.weight_scale);
  const double bound = two_stage::stable_step(ribbon, weight);
  spec.area_density *= (1.1 * dt / bound) * (1.1 * dt / bound);
}

/// Fig. 1a and 7 right: ends turned by pi against each other and held.
Setup twisted(int segments, double dt, double step_size, Way way) {
  Setup s{{}, {}, {}, options_of(way, step_size), dt, {}};
  geometry::RibbonSpec spec;
  spec.length = 2.5 * kPi;
  spec.width = 1;
  spec.segments = segments;
  spec.clamped = {true, true};
  soften(spec, s.options, dt);
  s.ribbon = geometry::make_ribbon(spec);
  const Quat frame = geometry::straight_state(s.ribbon).q.front();
  constraint::Surroundings held;
  for (const int end : {0, 1}) {
    constraint::Support support;
    support.node = end * segments;
    support.motion.keys = {{0, {Vec3(end * spec.length, 0, 0), frame}, 0},
                           {1, {Vec3(end * 0.8 * spec.length, 0, 0), frame}, end * kPi}};
    held.supports.push_back(support);
    const Pose pose = constraint::pose_at(support.motion, 1);
    two_stage::Support drive;
    drive.node = support.node;
    drive.position = pose.position;
    drive.frame = pose.frame;
    s.drive.supports.push_back(drive);
  }
  s.shape = at_rest(s.ribbon, held);
  return s;
}

/// Fig. 1c: the Moebius band.
Setup moebius(int segments, double dt, double step_size, Way way) {
  Setup s{{}, {}, {}, options_of(way, step_size), dt, {}};
  geometry::RibbonSpec spec;
  spec.length = 5 * kPi;
  spec.width = 1;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  spec.half_twists = 1;
  soften(spec, s.options, dt);
  s.ribbon = geometry::make_ribbon(spec);
  s.shape = at_rest(s.ribbon, {});
  return s;
}

/// Fig. 1d: the loop with two half twists that lies on itself, its inflections edge to edge.
Setup zero(int segments, double dt, double step_size, Way way) {
  Setup s{{}, {}, {}, options_of(way, step_size), dt, {}};
  geometry::RibbonSpec spec;
  spec.length = 5 * kPi;
  spec.width = 1;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  spec.half_twists = 2;
  soften(spec, s.options, dt);
  s.ribbon = geometry::make_ribbon(spec);
  s.surroundings.contact.self = true;
  s.surroundings.contact.distance = 2e-3;
  s.shape = at_rest(s.ribbon, s.surroundings);
  return s;
}

/// Fig. 7 left: a coiled belt, held at its start.
Setup coil(int segments, double dt, double step_size, Way way) {
  Setup s{{}, {}, {}, options_of(way, step_size), dt, {}};
  geometry::RibbonSpec spec;
  spec.length = 28;
  spec.width = 1;
  spec.segments = segments;
  spec.clamped = {true, false};
  soften(spec, s.options, dt);
  s.ribbon = geometry::make_ribbon(spec);
  const Quat frame = geometry::straight_state(s.ribbon).q.front();
  geometry::Chain chain = geometry::straight_chain(s.ribbon, {Vec3::Zero(), frame});
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    if (geometry::kappa_is_free(s.ribbon, static_cast<int>(i))) chain.kappa[i] = 0.5;
    if (geometry::eta_is_free(s.ribbon, static_cast<int>(i))) chain.eta[i] = 0.12;
  }
  s.shape = geometry::state_of(s.ribbon, chain, 0);
  two_stage::Support support;
  support.frame = frame;
  s.drive.supports = {support};
  return s;
}

/// A wave through the strip, a thousandth of the width in each `dt`.
void disturb(double dt, Setup& s) {
  for (std::size_t i = 0; i < s.shape.r.size(); ++i) {
    const double u = s.ribbon.node_u[i] / s.ribbon.length;
    s.shape.r_dot[i] = 0.02 * std::sin(2 * kPi * u) * Vec3(0.3, 1, 0.7) * s.ribbon.width / dt / 20;
  }
}

/// Runs of thirty steps from the same start, timed by the method itself.
void measure(benchmark::State& state, Setup s, double paper) {
  constexpr int kRun = 30;
  two_stage::Workspace work;
  if (s.surroundings.contact.self) s.drive.surroundings = &s.surroundings;
  double opt = 0, ode = 0, other = 0, contact = 0;
  long steps = 0, iterations = 0, failed = 0;
  for (auto _ : state) {
    two_stage::State at = two_stage::start(s.ribbon, s.shape);
    for (int k = 0; k < kRun; ++k) {
      const two_stage::StepReport report = two_stage::step(s.ribbon, s.drive, s.options, s.dt, at, work);
      opt += report.opt_seconds, ode += report.ode_seconds, other += report.other_seconds;
      contact += report.contact_seconds;
      iterations += report.iterations;
      ++steps;
      if (report.accepted) continue;
      ++failed;
      break;
    }
  }
  const double each = 1e3 / static_cast<double>(steps);
  state.counters["opt_ms"] = each * opt;
  state.counters["ode_ms"] = each * ode;
  state.counters["other_ms"] = each * other;
  state.counters["contact_ms"] = each * contact;
  state.counters["total_ms"] = each * (opt + ode + other + contact);
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(steps);
  state.counters["failed"] = static_cast<double>(failed);
  if (paper <= 0) return;
  state.counters["paper_ms"] = paper;
  state.counters["ratio"] = paper / (each * (opt + ode + other + contact));
}

void measure_row(benchmark::State& state, Setup s, double paper) {
  disturb(s.dt, s);
  measure(state, std::move(s), paper);
}

Way way_of(const benchmark::State& state) { return static_cast<Way>(state.range(0)); }

void Table1Fig1a(benchmark::State& state) { measure_row(state, twisted(35, 0.02, 0.05, way_of(state)), 11.04); }
void Table1Fig1c(benchmark::State& state) { measure_row(state, moebius(50, 0.01, 0.03, way_of(state)), 14.29); }
void Table1Fig1d(benchmark::State& state) { measure_row(state, zero(50, 0.01, 0.03, way_of(state)), 13.96); }
void Table1Fig7Left(benchmark::State& state) { measure_row(state, coil(45, 0.02, 0.05, way_of(state)), 11.65); }
void Table1Fig7Right(benchmark::State& state) { measure_row(state, twisted(45, 0.02, 0.05, way_of(state)), 11.22); }
/// The same motion of the same strip at every n; the stability bound shortens the step with n^2.
void Segments(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  Setup s = moebius(n, 0.01 * 2500 / (n * n), 0.05, Way::newton);
  disturb(0.01, s);
  measure(state, std::move(s), 0);
  state.SetComplexityN(n);
}

/// The scene drape-cylinder (Table 1, row 6): median time of a step of Algorithm 1 once the strip has met the cylinder,
/// and that of the same strip without the cylinder, bent by a wave, for comparison. `free_ms` is of the second.
void DrapeCylinder(benchmark::State& state) {
  constexpr double kStep = 1.4e-3, kPaper = 5.06;
  constexpr int kSteps = 1000, kMet = 100;
  geometry::RibbonSpec spec;
  spec.length = 0.3;
  spec.width = 0.03;
  spec.segments = 20;
  spec.bending_stiffness = 2e-5;
  spec.area_density = 0.1;
  constraint::Surroundings surroundings;
  constraint::Obstacle cylinder;
  cylinder.shape = contact::Cylinder{0.03, 0.1};
  cylinder.friction = 0.3;
  const Vec3 axis = Vec3(0.3, 1, 0).normalized();
  cylinder.motion.keys = {{0, {Vec3(0.14, 0, -0.06), math::shortest_rotation(Vec3::UnitZ(), axis)}, 0}};
  surroundings.obstacles = {cylinder};
  surroundings.contact.distance = 1e-3;
  Setup s{};
  s.ribbon = geometry::make_ribbon(spec);
  s.shape = geometry::straight_state(s.ribbon);
  s.options.ode.damping_tangent = s.options.ode.damping_normal = 1;
  s.dt = kStep;
  two_stage::Workspace work;
  const auto median = [&](int skip, const two_stage::Drive& drive, two_stage::State at) {
    std::vector<double> us;
    for (int k = 0; k < kSteps; ++k) {
      const two_stage::StepReport r = two_stage::step(s.ribbon, drive, s.options, s.dt, at, work);
      if (!r.accepted) state.SkipWithError(r.failure.c_str());
      if (k >= skip) us.push_back(1e6 * (r.ode_seconds + r.opt_seconds + r.contact_seconds + r.other_seconds));
    }
    std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(us.size() / 2), us.end());
    return us[us.size() / 2];
  };
  for (auto _ : state) {
    two_stage::Drive drive;
    drive.gravity = Vec3(0, 0, -9.81);
    drive.surroundings = &surroundings;
    state.counters["total_ms"] = 1e-3 * median(kMet, drive, two_stage::start(s.ribbon, s.shape));
    Setup free = s;
    disturb(0.01, free);
    state.counters["free_ms"] = 1e-3 * median(0, {}, two_stage::start(s.ribbon, free.shape));
  }
  state.counters["paper_ms"] = kPaper;
  state.counters["ratio"] = kPaper / state.counters["total_ms"];
}

// 0: Newton (the default), 1: L-BFGS with the direct projection, 2: as printed, with Gauss-Seidel.
BENCHMARK(Table1Fig1a)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Table1Fig1c)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Table1Fig1d)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Table1Fig7Left)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Table1Fig7Right)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(DrapeCylinder)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(Segments)->RangeMultiplier(2)->Range(25, 3200)->Unit(benchmark::kMillisecond)->Complexity(benchmark::oN);

}  // namespace
