#include "wunderlich/baseline/rod/motion.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::baseline::rod {

namespace {

/// A force and torque at a node, on the edge that follows (at the end of an open rod the last).
void add_load(const Rod& rod, const constraint::Load& load, double time, Objective& out) {
  const constraint::LoadKey key = constraint::load_at(load, time);
  const std::size_t node = static_cast<std::size_t>(load.node), edge = std::min(node, rod.edges() - 1);
  const bool turns = load.frame == constraint::LoadFrame::material && !key.force.isZero();
  if (!turns) out.force[node] += key.force;
  if (turns || !key.torque.isZero())
    out.followers.push_back(
        {node, edge, load.frame == constraint::LoadFrame::material, turns ? key.force : Vec3::Zero(), key.torque});
}

/// Loads and solids at `time`; no ties.
void place(const Rod& rod, const constraint::Surroundings& surroundings, double time, Objective& out) {
  out.force.resize(rod.nodes());
  for (std::size_t i = 0; i < rod.nodes(); ++i) out.force[i] = rod.node_mass[i] * surroundings.gravity;
  out.followers.clear();
  for (const constraint::Load& load : surroundings.loads) add_load(rod, load, time, out);
  out.node_tie.clear();
  out.solids = solids_at(rod, surroundings, time);
}

/// Springs that make the minimum the end of a step of length h: inertia, and drag by the tangents at its start.
void tie(const Rod& rod, const Damping& damping, double h, const State& state, Objective& out) {
  out.node_tie.resize(rod.nodes());
  out.node_goal.resize(rod.nodes());
  out.edge_tie.resize(rod.edges());
  out.edge_goal.resize(rod.edges());
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = i < rod.edges() ? i + 1 : i;
    const Vec3 t = (state.x[after] - state.x[before]).normalized();
    const Mat3 drag = damping.normal * Mat3::Identity() + (damping.tangent - damping.normal) * t * t.transpose();
    const Mat3 scaled = Mat3::Identity() + h * drag;
    out.node_tie[i] = rod.node_mass[i] / (h * h) * scaled;
    // m (x - x0 - h v0)/h^2 + m drag (x - x0)/h = tie (x - goal)
    out.node_goal[i] = state.x[i] + h * scaled.inverse() * state.v[i];
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const double scaled = 1 + h * damping.normal;
    out.edge_tie[j] = rod.edge_inertia[j] / (h * h) * scaled;
    out.edge_goal[j] = state.theta[j] + h / scaled * state.theta_dot[j];
  }
}

Report solve(const Rod& rod, const Options& options, State& state, Workspace& work) {
  return work.objective.has_potential() ? minimise(rod, options, state, work) : balance(rod, state, work);
}

}  // namespace

Report equilibrium(const Rod& rod, const constraint::Surroundings& surroundings, double time, const Options& options,
                   State& state, Workspace& work) {
  place(rod, surroundings, time, work.objective);
  hold(rod, surroundings.supports, state, time, true, work.unknowns);
  const Report report = solve(rod, options, state, work);
  if (report.converged()) state.time = time;
  return report;
}

Report step(const Rod& rod, const constraint::Surroundings& surroundings, const Damping& damping, double time,
            const Options& options, State& state, Workspace& work) {
  const double h = time - state.time;
  place(rod, surroundings, time, work.objective);
  tie(rod, damping, h, state, work.objective);
  hold(rod, surroundings.supports, state, time, false, work.unknowns);
  State next = state;
  Options moving = options;
  moving.leave_saddles = false;
  const Report report = solve(rod, moving, next, work);
  if (!report.converged()) return report;
  for (std::size_t i = 0; i < rod.nodes(); ++i) next.v[i] = (next.x[i] - state.x[i]) / h;
  for (std::size_t j = 0; j < rod.edges(); ++j) next.theta_dot[j] = (next.theta[j] - state.theta[j]) / h;
  next.time = time;
  state = next;
  return report;
}

double net_force(const Rod& rod, const constraint::Surroundings& surroundings, const State& state, Workspace& work) {
  place(rod, surroundings, state.time, work.objective);
  hold(rod, surroundings.supports, state, state.time, true, work.unknowns);
  std::fill(work.unknowns.given.begin(), work.unknowns.given.end(), 0.0);
  assemble(rod, work.objective, state, work.unknowns, work.system);
  const auto on = [&](std::size_t coordinate) {
    const int k = work.unknowns.number[coordinate];
    return k < 0 ? 0.0 : work.system.gradient[static_cast<std::size_t>(k)];
  };
  double largest = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i)
    largest = std::max(largest, Vec3(on(4 * i), on(4 * i + 1), on(4 * i + 2)).norm());
  for (std::size_t j = 0; j < rod.edges(); ++j) largest = std::max(largest, std::abs(on(4 * j + 3)) / rod.width);
  return largest;
}

double kinetic_energy(const Rod& rod, const State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i) sum += 0.5 * rod.node_mass[i] * state.v[i].squaredNorm();
  for (std::size_t j = 0; j < rod.edges(); ++j)
    sum += 0.5 * rod.edge_inertia[j] * state.theta_dot[j] * state.theta_dot[j];
  return sum;
}

double gravity_energy(const Rod& rod, const Vec3& gravity, const State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < rod.nodes(); ++i) sum -= rod.node_mass[i] * gravity.dot(state.x[i]);
  return sum;
}

}  // namespace wunderlich::baseline::rod
