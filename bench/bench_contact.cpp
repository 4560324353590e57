// What contact costs: steps of a strip that drapes itself over a cylinder beside the same strip in free fall, and the
// detection of contact, with solids and of a strip with itself, beside the linear solve as n grows, where every facet
// touches. Counters in seconds.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/implicit/implicit.hpp"

namespace {

using namespace wunderlich;
namespace implicit = solver::implicit;
using benchmark::Counter;

constexpr double kWidth = 0.03, kRadius = 0.03, kDistance = 1e-3;  // m

Counter seconds_each(double count) { return {count, Counter::kIsIterationInvariantRate | Counter::kInvert}; }

geometry::RibbonSpec strip(int segments) {
  geometry::RibbonSpec spec;
  spec.length = 0.015 * segments;
  spec.width = kWidth;
  spec.segments = segments;
  spec.bending_stiffness = 2e-5;
  spec.area_density = 0.1;
  return spec;
}

constraint::Obstacle solid(const contact::Shape& shape, const Vec3& position, const Vec3& axis, double friction) {
  constraint::Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.friction = friction;
  obstacle.motion.keys = {{0, {position, math::shortest_rotation(Vec3::UnitZ(), axis.normalized())}, 0}};
  return obstacle;
}

/// The scene `drape-cylinder`, or the same strip with nothing below it: the mean step of its first second and a half.
void StepDrape(benchmark::State& state) {
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -9.81);
  surroundings.contact.distance = kDistance;
  if (state.range(0) == 1) {
    surroundings.obstacles = {solid(contact::Cylinder{kRadius, 0.1}, Vec3(0.14, 0, -0.06), Vec3(0.3, 1, 0), 0.3)};
  }
  solver::PathOptions path_options;
  path_options.barrier = 1e-3;
  const solver::PathProblem path = solver::make_path(geometry::make_ribbon(strip(20)), surroundings, path_options);
  implicit::Options options;
  options.integrator = implicit::Integrator::bdf2;
  options.tolerance = 1e-5;
  options.drag_tangent = options.drag_normal = 1;
  implicit::Workspace work;
  const double dt = 1e-6 * static_cast<double>(state.range(1));
  const int steps = static_cast<int>(std::lround(1.5 / dt));
  long iterations = 0;
  implicit::State at;
  const auto advance = [&](const auto& self, double t1, int halvings) -> void {
    const implicit::StepReport report = implicit::step(path, options, t1, halvings, at, work);
    iterations += report.iterations;
    if (report.accepted) return;
    if (halvings == 10) std::abort();
    self(self, at.time() + 0.5 * (t1 - at.time()), halvings + 1);
    self(self, t1, halvings + 1);
  };
  for (auto _ : state) {
    at = implicit::start(path, options, geometry::straight_state(path.ribbon), Vec3::Zero(), work);
    for (int i = 1; i <= steps; ++i) advance(advance, i * dt, 0);
  }
  state.counters["s_per_step"] = seconds_each(steps);
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(state.iterations()) / steps;
}

/// A strip that lies on a plane (0) or along a cylinder (1), so that each of its facets touches.
struct Lying {
  geometry::Ribbon ribbon;
  geometry::Chain chain;
  solver::ChainProblem problem;
  solver::NewtonWorkspace work;

  explicit Lying(const benchmark::State& state)
      : ribbon(geometry::make_ribbon(strip(static_cast<int>(state.range(1))))) {
    constraint::Surroundings surroundings;
    surroundings.gravity = Vec3(0, 0, -9.81);
    surroundings.contact.distance = kDistance;
    const bool round = state.range(0) == 1;
    const contact::Shape shape =
        round ? contact::Shape(contact::Cylinder{kRadius, 1e9}) : contact::Shape(contact::HalfSpace{});
    surroundings.obstacles = {solid(shape, Vec3(0, 0, round ? -kRadius : 0), round ? Vec3::UnitX() : Vec3::UnitZ(), 0)};
    solver::place_solids(ribbon, surroundings, 0, problem.contact);
    const double side = ribbon.rest_length.front() / problem.contact.along, cell = kWidth / problem.contact.across;
    const double margin = round ? (side * side + cell * cell) / (8 * kRadius) : 0;
    Pose base{Vec3(0, 0, 0.9 * kDistance + margin), geometry::straight_state(ribbon).q.front()};
    chain = geometry::straight_chain(ribbon, base);
    const auto nodes = static_cast<std::size_t>(ribbon.node_count());
    problem.force.assign(nodes, Vec3::Zero());
    problem.tie.assign(nodes, 10);
    geometry::forward_kinematics(ribbon, chain, work.kinematics);
    problem.anchor = work.kinematics.r;
    find();
    work.trial_touching.points = work.touching.points;
    if (work.touching.points.touches.empty()) std::abort();
  }
  void find() { solver::find_points(ribbon, problem.contact, chain, work.kinematics, work.touching.points); }
};

void Detection(benchmark::State& state) {
  Lying lying(state);
  for (auto _ : state) {
    lying.find();
    benchmark::DoNotOptimize(
        may_go(lying.problem.contact, lying.work.trial_touching.points, lying.work.touching.points));
  }
  state.counters["s_per_segment"] = seconds_each(static_cast<double>(state.range(1)));
}

/// Derivatives, with those of contact, and the sweep.
void Solve(benchmark::State& state) {
  Lying lying(state);
  const std::vector<double> multipliers;
  for (auto _ : state) {
    solver::linearise(lying.ribbon, lying.problem, lying.chain, lying.work.kinematics, multipliers, lying.work.touching,
                      lying.work.system);
    benchmark::DoNotOptimize(math::chain_step(lying.work.system, lying.work.sweep, lying.work.step));
  }
  state.counters["s_per_segment"] = seconds_each(static_cast<double>(state.range(1)));
}

/// A strip rolled up, its layers four fifths of the barrier's distance apart, so that each of its facets touches two
/// others.
struct Rolled {
  geometry::Ribbon ribbon;
  geometry::Chain chain;
  solver::ChainProblem problem;
  solver::NewtonWorkspace work;
  solver::SelfContact self;
  solver::SelfSearch search;
  solver::SelfContacts contacts, trial;
  std::vector<solver::StripPlace> places;
  std::vector<math::ChainCoupling> between;

  explicit Rolled(int segments) : ribbon(geometry::make_ribbon(spec_of(segments))) {
    constraint::Surroundings surroundings;
    surroundings.contact.self = true;
    surroundings.contact.distance = kDistance;
    chain = geometry::straight_chain(ribbon, {});
    const double pitch = 0.8 * kDistance;
    double s = 0;
    for (std::size_t i = 1; i < ribbon.rest_length.size(); ++i) {
      s += ribbon.rest_length[i - 1];
      chain.kappa[i] = 1 / std::sqrt(kRadius * kRadius + pitch * s / EIGEN_PI);
    }
    const auto nodes = static_cast<std::size_t>(ribbon.node_count());
    problem.force.assign(nodes, Vec3::Zero());
    problem.tie.assign(nodes, 10);
    geometry::forward_kinematics(ribbon, chain, work.kinematics);
    problem.anchor = work.kinematics.r;
    solver::place_self(ribbon, surroundings, kDistance, true, chain.eta, self);
    places.push_back({ribbon, chain, work.kinematics});
    solver::find_pairs(places, self, search, contacts);
    if (contacts.pairs.size() < nodes && segments > 200) std::abort();
    trial = contacts;
  }
  static geometry::RibbonSpec spec_of(int segments) {
    geometry::RibbonSpec spec = strip(segments);
    spec.length = 0.004 * segments;
    return spec;
  }
};

void SelfDetection(benchmark::State& state) {
  Rolled roll(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver::travel(roll.places, roll.self, roll.contacts, roll.search, roll.trial));
  }
  state.counters["s_per_segment"] = seconds_each(static_cast<double>(state.range(0)));
  state.counters["pairs_per_segment"] =
      static_cast<double>(roll.contacts.pairs.size()) / static_cast<double>(state.range(0));
}

/// Derivatives, with those of contact, and the sparse factorisation.
void SelfSolve(benchmark::State& state) {
  Rolled roll(static_cast<int>(state.range(0)));
  const std::vector<double> multipliers;
  solver::NewtonWorkspace& work = roll.work;
  math::ChainSystem* const systems[] = {&work.system};
  const math::ChainPart parts[] = {{&work.system, &work.sweep, &work.step}};
  for (auto _ : state) {
    roll.between.clear();
    solver::linearise(roll.ribbon, roll.problem, roll.chain, work.kinematics, multipliers, work.touching, work.system);
    solver::add_self_contact(roll.places, roll.self, roll.contacts, systems, roll.between);
    if (!math::chain_steps(parts, roll.between)) std::abort();
  }
  state.counters["s_per_segment"] = seconds_each(static_cast<double>(state.range(0)));
}

// Arguments: 0 in free fall, 1 with the cylinder; the step in microseconds.
BENCHMARK(StepDrape)->ArgsProduct({{0, 1}, {1000, 2000, 5000, 10000}})->Unit(benchmark::kMillisecond);
// Arguments: 0 on a plane, 1 along a cylinder; segments.
BENCHMARK(Detection)->ArgsProduct({{0, 1}, {50, 100, 400, 1600, 6400}})->Unit(benchmark::kMicrosecond);
BENCHMARK(Solve)->ArgsProduct({{0, 1}, {50, 100, 400, 1600, 6400}})->Unit(benchmark::kMicrosecond);
// Argument: segments.
BENCHMARK(SelfDetection)->Arg(400)->Arg(1600)->Arg(6400)->Unit(benchmark::kMicrosecond);
BENCHMARK(SelfSolve)->Arg(400)->Arg(1600)->Arg(6400)->Unit(benchmark::kMicrosecond);

}  // namespace
