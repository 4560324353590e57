#include "wunderlich/solver/two_stage/transport.hpp"

#include <algorithm>

#include "wunderlich/constraint/holding.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver::two_stage {

using constraint::Orientation;
using geometry::Ribbon;

namespace {

Vec3 edge_direction(const geometry::State& shape, std::size_t segment) {
  return (shape.r[segment + 1] - shape.r[segment]).normalized();
}

void add_torques(const Ribbon& ribbon, const Drive& drive, Workspace& work) {
  const int last = ribbon.segments - 1;
  work.torque.assign(ribbon.rest_length.size(), Vec3::Zero());
  for (const Load& load : drive.loads) {
    const bool seam = ribbon.is_loop() && (load.node == 0 || load.node > last);
    const int before = seam ? last : std::max(load.node - 1, 0), after = seam ? 0 : std::min(load.node, last);
    work.torque[static_cast<std::size_t>(before)] += 0.5 * load.torque;
    work.torque[static_cast<std::size_t>(after)] += 0.5 * load.torque;
  }
}

}  // namespace

int held_segment(const Ribbon& ribbon, const Support& support) {
  if (support.segment >= 0) return support.segment;
  const bool own = !ribbon.is_loop() && (support.node == 0 || support.node == ribbon.segments);
  if (own && support.orientation == Orientation::full) return -1;
  return std::min(support.node, ribbon.segments - 1);
}

void set_up_holding(const Ribbon& ribbon, const Drive& drive, Workspace& work) {
  const auto nodes = static_cast<std::size_t>(ribbon.node_count());
  Holding& holding = work.holding;
  holding.inverse_mass.resize(nodes);
  holding.target.assign(nodes, Vec3::Zero());
  holding.frame_held.assign(nodes - 1, 0);
  holding.eta_held.assign(nodes, 0);
  for (std::size_t i = 0; i < nodes; ++i) {
    holding.inverse_mass[i].setConstant(ribbon.node_mass[i] > 0 ? 1 / ribbon.node_mass[i] : 0);
  }
  for (const Support& support : drive.supports) {
    const bool seam = ribbon.is_loop() && support.node == ribbon.segments;
    const auto node = static_cast<std::size_t>(seam ? 0 : support.node);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!support.hold_position[k]) continue;
      const auto axis = static_cast<Eigen::Index>(k);
      holding.inverse_mass[node][axis] = 0;
      holding.target[node][axis] = support.position[axis];
    }
    if (support.orientation == Orientation::free) continue;
    const int segment = held_segment(ribbon, support);
    if (segment >= 0) holding.frame_held[static_cast<std::size_t>(segment)] = 1;
  }
  if (!ribbon.is_loop() && !ribbon.free_rulings) holding.eta_held.front() = holding.eta_held.back() = 1;
  add_torques(ribbon, drive, work);
}

void transport_frames(const Ribbon& ribbon, const std::vector<double>& spin, double dt, geometry::State& shape,
                      Workspace& work) {
  work.carried.resize(shape.q.size());
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Vec3 before = (work.r_start[s + 1] - work.r_start[s]).normalized();
    const Quat turn = math::shortest_rotation(before, edge_direction(shape, s));
    work.carried[s] = (turn * shape.q[s] * math::exp_map(Vec3(0, 0, spin[s] * dt))).normalized();
    if (!work.holding.frame_held[s]) shape.q[s] = work.carried[s];
  }
  work.torque_frame = shape.q;
}

void set_held_frames(const Ribbon& ribbon, const Drive& drive, const geometry::State& before, geometry::State& shape) {
  for (const Support& support : drive.supports) {
    if (support.orientation == Orientation::free) continue;
    const int segment = held_segment(ribbon, support);
    if (segment < 0) {
      Quat& end = shape.end_frame[support.node == 0 ? 0 : 1];
      end = nearer(support.frame, end);
      continue;
    }
    const auto s = static_cast<std::size_t>(segment);
    Quat target = support.frame;
    if (support.orientation == Orientation::about_tangent) {
      target = constraint::transported(before.q[s], edge_direction(shape, s)) * math::exp_map(Vec3(0, 0, support.turn));
    }
    shape.q[s] = nearer(target.normalized(), before.q[s]);
  }
}

}  // namespace wunderlich::solver::two_stage
