#include "solver/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/geometry/surface.hpp"

namespace wunderlich::testing {

using constraint::Support;
using geometry::RibbonSpec;

namespace {

solver::PathOptions with_barrier(double barrier) {
  solver::PathOptions options;
  options.barrier = barrier;
  return options;
}

}  // namespace

PathEnd run_path(const RibbonSpec& spec, const constraint::Surroundings& surroundings,
                 const solver::PathOptions& options) {
  PathEnd end;
  end.path = solver::make_path(geometry::make_ribbon(spec), surroundings, options);
  end.at = solver::start_path(end.path);
  solver::NewtonWorkspace work;
  for (int failures = 0; end.at.phase != solver::Phase::done && failures < 50;) {
    const solver::PathStep step = solver::advance(end.path, end.at, work);
    if (!step.accepted) end.failure = step.failure;
    if (step.exhausted) break;
    failures = step.accepted ? 0 : failures + 1;
  }
  end.done = end.at.phase == solver::Phase::done;
  const geometry::Ribbon& ribbon = solver::ribbon_of(end.path, end.at);
  end.shape = geometry::state_of(ribbon, end.at.chain, end.at.clock);
  end.energy = solver::elastic_energy(ribbon, options.model, end.at.chain);
  return end;
}

Quat straight_frame() { return geometry::straight_state(geometry::make_ribbon({})).q.front(); }

Support clamp(int node, const Pose& pose) {
  Support support;
  support.node = node;
  support.motion.keys = {{0, pose, 0}};
  return support;
}

Support moving_clamp(int node, const Pose& from, const Vec3& to, double turn) {
  Support support = clamp(node, from);
  support.motion.keys.push_back({1, {to, from.frame}, turn});
  return support;
}

PathEnd cantilever(int segments, const Vec3& gravity, double barrier) {
  RibbonSpec spec;
  spec.segments = segments;
  spec.clamped = {true, false};
  constraint::Surroundings surroundings;
  surroundings.gravity = gravity;
  surroundings.supports = {clamp(0, {Vec3::Zero(), straight_frame()})};
  return run_path(spec, surroundings, with_barrier(barrier));
}

PathEnd buckled(int segments, double chord, double barrier) {
  RibbonSpec spec;
  spec.segments = segments;
  spec.clamped = {true, true};
  const Quat frame = straight_frame();
  constraint::Surroundings surroundings;
  surroundings.supports = {clamp(0, {Vec3::Zero(), frame}),
                           moving_clamp(segments, {Vec3(1, 0, 0), frame}, Vec3(chord, 0, 0), 0)};
  return run_path(spec, surroundings, with_barrier(barrier));
}

PathEnd twist_clamped(int segments, double barrier) {
  RibbonSpec spec;
  spec.length = 2 * kPi;
  spec.width = 0.8;
  spec.segments = segments;
  spec.clamped = {true, true};
  const Quat frame = straight_frame();
  constraint::Surroundings surroundings;
  surroundings.supports = {moving_clamp(0, {Vec3::Zero(), frame}, Vec3::Zero(), -kPi / 2),
                           moving_clamp(segments, {Vec3(2 * kPi, 0, 0), frame}, Vec3(1.6 * kPi, 0, 0), kPi / 2)};
  return run_path(spec, surroundings, with_barrier(barrier));
}

PathEnd moebius(int segments, double width, double barrier) {
  RibbonSpec spec;
  spec.length = 2 * kPi;
  spec.width = width;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  spec.half_twists = 1;
  return run_path(spec, {}, with_barrier(barrier));
}

void expect_exact(const PathEnd& end) {
  EXPECT_TRUE(end.done) << end.failure;
  const ConstraintErrors e = constraint::errors(end.ribbon(), end.shape);
  EXPECT_LE(std::max({e.max_length_error, e.max_parallel_error, e.max_binormal, e.max_torsion_mismatch}), 1e-9);
  EXPECT_LE(geometry::area_error(end.ribbon(), end.shape), 1e-10);
}

void expect_second_order(const std::vector<double>& errors) {
  for (std::size_t k = 1; k < errors.size(); ++k) {
    EXPECT_GE(std::log2(errors[k - 1] / errors[k]), 1.8) << errors[k - 1] << " " << errors[k];
  }
}

bool is_slow_build() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
  return true;
#else
  return false;
#endif
}

}  // namespace wunderlich::testing
