#include "two_stage/cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/solver/equilibrium.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/transport.hpp"

namespace wunderlich::testing {

namespace {

Case sheet(int segments, bool clamped) {
  geometry::RibbonSpec spec;
  spec.length = 0.3;
  spec.width = 0.03;
  spec.segments = segments;
  spec.bending_stiffness = 2.7e-4;
  spec.area_density = 0.1;
  spec.clamped = {clamped, false};
  Case c;
  c.ribbon = geometry::make_ribbon(spec);
  c.state = two_stage::start(c.ribbon, geometry::straight_state(c.ribbon));
  return c;
}

template <typename T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

Case cantilever(int segments, double tilt) {
  Case c = sheet(segments, true);
  c.drive.gravity = 9.81 * Vec3(0, std::sin(tilt), -std::cos(tilt));
  two_stage::Support support;
  support.frame = c.state.shape.end_frame[0];
  c.drive.supports = {support};
  return c;
}

Case floating(int segments) { return sheet(segments, false); }

Case loop(int segments, int half_twists, const constraint::Surroundings& surroundings) {
  geometry::RibbonSpec spec;
  spec.length = 2 * M_PI;
  spec.width = 0.4;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  spec.half_twists = half_twists;
  Case c;
  c.ribbon = geometry::make_ribbon(spec);
  solver::PathOptions options;
  if (surroundings.contact.self) options.loop_path = solver::LoopPath::twist;
  const solver::PathProblem path = solver::make_path(c.ribbon, surroundings, options);
  solver::PathState at = solver::start_path(path);
  solver::NewtonWorkspace work;
  while (at.phase != solver::Phase::done && !solver::advance(path, at, work).exhausted) {
  }
  EXPECT_EQ(at.phase, solver::Phase::done);
  c.state = two_stage::start(c.ribbon, geometry::state_of(c.ribbon, at.chain, 0));
  return c;
}

void disturb(double speed, Case& c) {
  auto& shape = c.state.shape;
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    const double u = 2 * M_PI * c.ribbon.node_u[i] / c.ribbon.length;
    shape.r_dot[i] = speed * Vec3(std::cos(2 * u), std::sin(u), std::sin(3 * u));
  }
  if (c.ribbon.is_loop()) shape.r_dot.back() = shape.r_dot.front();
}

two_stage::StepReport run(double dt, int steps, Case& c) {
  two_stage::StepReport report;
  for (int k = 0; k < steps; ++k) {
    report = two_stage::step(c.ribbon, c.drive, c.options, dt, c.state, c.work);
    EXPECT_TRUE(report.accepted) << "step " << k << ": " << report.failure;
    if (!report.accepted) break;
  }
  return report;
}

void prepare(const two_stage::Options& options, const geometry::Ribbon& ribbon, const two_stage::Drive& drive,
             const geometry::State& shape, two_stage::Workspace& work) {
  two_stage::set_up_views(ribbon, work);
  two_stage::set_up_holding(ribbon, drive, work);
  work.parallel_weight = two_stage::rest_parallel_weight(ribbon, options.ode.weight_scale);
  work.inertia.assign(shape.q.size(), 0.0);
  work.carried = work.torque_frame = shape.q;
  work.before = shape;
  work.q_start = shape.q;
  work.eta_start = shape.eta;
}

bool same_bits(const two_stage::State& a, const two_stage::State& b) {
  return same(a.shape.r, b.shape.r) && same(a.shape.r_dot, b.shape.r_dot) && same(a.shape.q, b.shape.q) &&
         same(a.shape.eta, b.shape.eta) && same(a.spin, b.spin) && same(a.multipliers, b.multipliers) &&
         a.shape.time == b.shape.time;
}

}  // namespace wunderlich::testing
