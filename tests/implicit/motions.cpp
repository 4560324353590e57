#include "implicit/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "solver/paths.hpp"
#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/geometry/surface.hpp"

namespace wunderlich::testing {

namespace {

constexpr int kMostHalvings = 8;

bool move(double t1, int halvings, Motion& motion) {
  motion.deepest = std::max(motion.deepest, halvings);
  const implicit::StepReport report =
      implicit::step(motion.path, motion.options, t1, halvings, motion.state, motion.work);
  ++motion.steps;
  motion.iterations += report.iterations;
  motion.repeats += report.repeats;
  motion.impulses += report.inelastic ? 1 : 0;
  if (report.accepted) return true;
  motion.failure = report.failure;
  if (halvings == kMostHalvings) return false;
  ++motion.halvings;
  const double middle = 0.5 * (motion.state.strips[0].path.t + t1);
  return move(middle, halvings + 1, motion) && move(t1, halvings + 1, motion);
}

}  // namespace

geometry::RibbonSpec sheet(double bending_stiffness, bool clamped) {
  geometry::RibbonSpec spec;
  spec.length = 0.3;
  spec.width = 0.03;
  spec.segments = 50;
  spec.bending_stiffness = bending_stiffness;
  spec.area_density = 0.1;
  spec.clamped = {clamped, false};
  return spec;
}

constraint::Support level_clamp(const geometry::RibbonSpec& spec, int node) {
  const geometry::State straight = geometry::straight_state(geometry::make_ribbon(spec));
  constraint::Support support;
  support.node = node;
  support.motion.keys = {{0, {straight.r[static_cast<std::size_t>(node)], straight.q.front()}, 0}};
  return support;
}

Motion make_motion(const geometry::RibbonSpec& spec, const constraint::Surroundings& surroundings, double barrier) {
  Motion motion;
  solver::PathOptions options;
  options.barrier = barrier;
  motion.path = solver::make_path(geometry::make_ribbon(spec), surroundings, options);
  motion.options.barrier = barrier;
  return motion;
}

Motion swing(double bending_stiffness, double tilt) {
  const geometry::RibbonSpec spec = sheet(bending_stiffness, true);
  constraint::Surroundings surroundings;
  surroundings.supports = {level_clamp(spec, 0)};
  surroundings.gravity = 9.81 * Vec3(0, std::sin(tilt), -std::cos(tilt));
  Motion motion = make_motion(spec, surroundings);
  start(motion);
  return motion;
}

Motion between_clamps() {
  geometry::RibbonSpec spec = sheet(2.7e-4, true);
  spec.clamped = {true, true};
  const Pose level = level_clamp(spec, 50).motion.keys[0].pose;
  constraint::Surroundings held;
  held.supports = {level_clamp(spec, 0), moving_clamp(50, level, Vec3(0.29, 0, 0), 0)};
  const PathEnd bow = run_path(spec, held, {});
  EXPECT_TRUE(bow.done) << bow.failure;
  const Pose from{bow.shape.r.back(), bow.shape.end_frame[1]};
  held.supports.back() = clamp(50, from);
  held.supports.back().motion.keys.push_back({0.3, {from.position - Vec3(0.06, 0, -0.02), from.frame}, 2});
  held.gravity = Vec3(0, 1, -9.7);
  Motion motion = make_motion(spec, held);
  geometry::State shape = bow.shape;
  shape.time = 0;
  start(shape, Vec3::Zero(), motion);
  return motion;
}

void start(Motion& motion) { start(geometry::straight_state(motion.path.ribbon), Vec3::Zero(), motion); }

void start(const geometry::State& shape, const Vec3& spin, Motion& motion) {
  motion.state = implicit::start(motion.path, motion.options, shape, spin, motion.work);
}

void start(const geometry::Chain& chain, Motion& motion) {
  start(geometry::state_of(motion.path.ribbon, chain, 0), Vec3::Zero(), motion);
}

bool move_to(double t1, Motion& motion) { return move(t1, 0, motion); }

double kinetic(const Motion& motion) {
  return implicit::kinetic_energy(motion.path.ribbon, motion.options.kinetic, motion.state.strips[0].points,
                                  motion.state.strips[0].path.chain.eta);
}

double total_energy(const Motion& motion) {
  const geometry::State shape = implicit::shape_of(motion.path, motion.state);
  return motion.state.elastic + kinetic(motion) +
         energy::gravity_value(motion.path.ribbon, motion.path.surroundings.gravity, shape);
}

void look(const Motion& motion, Exactness& worst) {
  const geometry::State shape = implicit::shape_of(motion.path, motion.state);
  const ConstraintErrors e = constraint::errors(motion.path.ribbon, shape);
  for (const Vec3& r : shape.r) EXPECT_TRUE(r.allFinite());
  worst.internal =
      std::max({worst.internal, e.max_length_error, e.max_parallel_error, e.max_binormal, e.max_torsion_mismatch});
  worst.area = std::max(worst.area, geometry::area_error(motion.path.ribbon, shape));
  worst.ruling = std::max(worst.ruling, e.max_ruling_ratio);
}

void expect_exact(const Exactness& worst) {
  show("internal constraints", worst.internal, 1e-12);
  show("area error", worst.area, 1e-10);
  show("largest |x|", worst.ruling, 1);
  EXPECT_LE(worst.internal, 1e-12);
  EXPECT_LE(worst.area, 1e-10);
  EXPECT_LT(worst.ruling, 1);
}

void show(const std::string& name, double measured, double asked) {
  std::printf("  %-40s %.3g (asked: %.3g)\n", name.c_str(), measured, asked);
  std::string key = name;
  std::replace_if(
      key.begin(), key.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  char value[32];
  std::snprintf(value, sizeof value, "%.6g", measured);
  ::testing::Test::RecordProperty(key, value);
}

}  // namespace wunderlich::testing
