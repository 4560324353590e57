// Steel foil, paper and silicone through buckling, snap-through and whips, at steps of 1 to 20 ms; and long random
// motions. A step may be halved 8 times; nothing may fail.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

struct Material {
  const char* name;
  double length, width, bending_stiffness, area_density;
};
constexpr Material kMaterials[] = {
    // E = 200 GPa, nu = 0.3, 7850 kg/m^3, 0.1 mm: E h^3 / (12 (1 - nu^2))
    {"steel foil", 0.5, 0.02, 200e9 * 1e-12 / (12 * 0.91), 0.785},
    {"paper", 0.3, 0.03, 2.7e-4, 0.1},
    {"silicone", 0.3, 0.03, 1e-6, 1},
};
constexpr double kSteps[] = {1e-3, 5e-3, 20e-3};

geometry::RibbonSpec spec_of(const Material& material, bool both_clamped) {
  geometry::RibbonSpec spec;
  spec.length = material.length;
  spec.width = material.width;
  spec.bending_stiffness = material.bending_stiffness;
  spec.area_density = material.area_density;
  spec.segments = 50;
  spec.clamped = {true, both_clamped};
  return spec;
}

/// Runs, expects that every step is taken, and prints what it cost.
void run(const char* what, const Material& material, double dt, double duration, Motion& m) {
  Exactness worst;
  const int count = static_cast<int>(std::lround(duration / dt));
  bool fine = true;
  for (int i = 1; i <= count && fine; ++i) {
    fine = move_to(dt * i, m);
    look(m, worst);
  }
  std::printf(
      "  %-12s %-11s %5.0f ms: %5d steps %6d iterations %4d halvings (to 1/%d) %3d repeats %3d impulses, %s%s\n", what,
      material.name, 1e3 * dt, m.steps, m.iterations, m.halvings, 1 << m.deepest, m.repeats, m.impulses,
      fine ? "done" : "FAILED: ", fine ? "" : m.failure.c_str());
  EXPECT_TRUE(fine) << what << " " << material.name << " " << dt << ": " << m.failure;
  EXPECT_LE(worst.internal, 1e-12);
  EXPECT_LE(worst.area, 1e-10);
  EXPECT_LT(worst.ruling, 1);
}

/// The strip level between clamps, bowed by what brings them together to `share` of its length.
PathEnd arc(const Material& material, double share) {
  const geometry::RibbonSpec spec = spec_of(material, true);
  const Quat frame = straight_frame();
  constraint::Surroundings between;
  between.supports = {clamp(0, {Vec3::Zero(), frame}),
                      moving_clamp(50, {Vec3(spec.length, 0, 0), frame}, Vec3(share * spec.length, 0, 0), 0)};
  solver::PathOptions options;
  options.barrier = 1e-3;
  return run_path(spec, between, options);
}

Motion from_arc(const Material& material, const PathEnd& start_shape, const Vec3& to, const Quat& frame, double time) {
  const Vec3 from = start_shape.shape.r.back();
  constraint::Surroundings between;
  between.supports = {clamp(0, {Vec3::Zero(), straight_frame()}), clamp(50, {from, straight_frame()})};
  between.supports[1].motion.keys.push_back({time, {to, frame}, 0});
  between.gravity = 9.81 * Vec3(0, 0.05, -1);
  Motion m = make_motion(spec_of(material, true), between);
  geometry::State shape = start_shape.shape;
  shape.time = 0;
  start(shape, Vec3::Zero(), m);
  return m;
}

TEST(Robustness, EndsPushedTogether) {
  for (const Material& material : kMaterials) {
    const PathEnd shape = arc(material, 0.99);
    ASSERT_TRUE(shape.done) << shape.failure;
    for (const double dt : kSteps) {
      Motion m = from_arc(material, shape, Vec3(0.4 * material.length, 0, 0), straight_frame(), 0.3);
      run("buckling", material, dt, 0.5, m);
    }
  }
}

TEST(Robustness, AnArcWhoseClampTurnsSnaps) {
  for (const Material& material : kMaterials) {
    const PathEnd shape = arc(material, 0.85);
    ASSERT_TRUE(shape.done) << shape.failure;
    for (const double dt : kSteps) {
      // One way, both ways: the arc may stand up or hang down.
      for (const double turn : {2.5, -2.5}) {
        const Quat frame = math::exp_map(Vec3(0.2, turn, 0)) * straight_frame();
        Motion m = from_arc(material, shape, shape.shape.r.back(), frame, 0.3);
        run("snap", material, dt, 0.5, m);
      }
    }
  }
}

TEST(Robustness, WhipsFromTheHorizontal) {
  for (const Material& material : kMaterials) {
    for (const double dt : kSteps) {
      const geometry::RibbonSpec spec = spec_of(material, false);
      constraint::Surroundings held;
      held.supports = {level_clamp(spec, 0)};
      held.gravity = 9.81 * Vec3(0, std::sin(0.3), -std::cos(0.3));
      Motion m = make_motion(spec, held);
      start(m);
      run("whip", material, dt, 1, m);
    }
  }
}

TEST(Robustness, EveryIntegratorGoesThroughAWhip) {
  const Material& paper = kMaterials[1];
  const char* names[] = {"Euler", "BDF2", "alpha"};
  for (const auto kind :
       {implicit::Integrator::euler, implicit::Integrator::bdf2, implicit::Integrator::generalised_alpha}) {
    for (const auto kinetic : {implicit::KineticEnergy::centerline, implicit::KineticEnergy::full}) {
      Motion m = swing(paper.bending_stiffness, 0.3);
      m.options.integrator = kind;
      m.options.kinetic = kinetic;
      start(m);
      run(names[static_cast<int>(kind)], paper, 5e-3, 0.5, m);
    }
  }
}

double uniform(std::mt19937& engine) { return static_cast<double>(engine()) / 2147483648.0 - 1; }

/// Paper between two clamps, one shaken at random, the other turned; half of the way on it lets go. Random forces act
/// on its middle all the time.
void soak(unsigned seed, int steps) {
  std::mt19937 engine(seed);
  const Material& paper = kMaterials[1];
  const double dt = 2e-3;
  geometry::RibbonSpec spec = spec_of(paper, true);
  const PathEnd shape = arc(paper, 0.9);
  ASSERT_TRUE(shape.done) << shape.failure;
  constraint::Surroundings held;
  constraint::Support first = clamp(0, {Vec3::Zero(), straight_frame()});
  constraint::Support last = clamp(50, {shape.shape.r.back(), straight_frame()});
  constraint::Load push;
  push.node = 25;
  const double weight = 9.81 * paper.area_density * paper.length * paper.width;
  for (double t = 0.05; t < dt * steps; t += 0.05) {
    const auto random = [&] { return Vec3(uniform(engine), uniform(engine), uniform(engine)); };
    first.motion.keys.push_back({t, {0.01 * random(), math::exp_map(0.3 * random()) * straight_frame()}, 0});
    last.motion.keys.push_back({t, last.motion.keys[0].pose, 1.5 * uniform(engine)});
    push.keys.push_back({t, 0.5 * weight * random(), Vec3::Zero()});
  }
  held.supports = {first, last};
  held.loads = {push};
  held.gravity = Vec3(0, 0, -9.81);
  Motion m = make_motion(spec, held);
  m.options.drag_normal = 1;  // what the shaking puts in must go somewhere
  geometry::State start_shape = shape.shape;
  start_shape.time = 0;
  start(start_shape, Vec3::Zero(), m);
  Exactness worst;
  bool fine = true;
  for (int i = 1; i <= steps && fine; ++i) {
    fine = move_to(dt * i, m);
    look(m, worst);
    if (i != steps / 2) continue;
    spec.clamped = {true, false};
    held.supports = {first};
    const solver::PathProblem before = m.path;
    m.path = solver::make_path(geometry::make_ribbon(spec), held, before.options);
    implicit::change_supports(before, m.path, m.state.strips.front());
    implicit::find_accelerations(implicit::Paths(&m.path, 1), m.options, m.state, m.work);
  }
  std::printf("  seed %u: %d steps %d iterations %d halvings (to 1/%d) %d repeats, |x| to %.4f, %s\n", seed, m.steps,
              m.iterations, m.halvings, 1 << m.deepest, m.repeats, worst.ruling, fine ? "done" : m.failure.c_str());
  EXPECT_TRUE(fine) << "seed " << seed << ": " << m.failure;
  EXPECT_LE(worst.internal, 1e-12);
  EXPECT_LE(worst.area, 1e-10);
  EXPECT_LT(worst.ruling, 1);
}

TEST(Soak, AShakenTwistedReleasedStrip) {
  for (const unsigned seed : {1u, 2u, 3u}) soak(seed, is_slow_build() ? 200 : 1000);
}

/// Hours of motion, for tools/nightly.sh: WUNDERLICH_SOAK_STEPS says how many steps.
TEST(Soak, Long) {
  const char* steps = std::getenv("WUNDERLICH_SOAK_STEPS");
  if (steps == nullptr) GTEST_SKIP() << "set WUNDERLICH_SOAK_STEPS=100000";
  for (const unsigned seed : {11u, 12u, 13u, 14u, 15u}) soak(seed, std::atoi(steps) / 5);
}

}  // namespace
}  // namespace wunderlich::testing
