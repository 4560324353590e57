#include "wunderlich/math/chain_sparse.hpp"

namespace wunderlich::math {

void find_wrenches(const ChainSystem& system, std::vector<NodeWrench>& w, Vec6& base_gradient) {
  const std::size_t count = system.links.size();
  w.assign(count, {Vec3::Zero(), Vec3::Zero(), Vec2::Zero(), 0});  // first each node's own, then with all beyond
  base_gradient.setZero();
  for (std::size_t i = 0; i < count; ++i) {
    const ChainLink& link = system.links[i];
    w[i].force += first_three(link.force);
    if (i + 1 < count) w[i].gradient += link.grad_a, w[i + 1].gradient += link.grad_b;
    if (i < system.turns.size()) {
      const TurnTerm& turn = system.turns[i];
      w[i].torque += Vec3(turn.hessian[0][3], turn.hessian[1][3], turn.hessian[2][3]);
    }
  }
  const auto add = [&](int node, const Vec3& force, const Vec3& torque) {
    if (node < 0) {
      base_gradient.head<3>() += force;
      base_gradient.tail<3>() += torque;
    } else {
      w[static_cast<std::size_t>(node)].force += force;
      w[static_cast<std::size_t>(node)].torque += torque;
    }
  };
  for (const PoseTerm& term : system.pose_terms) add(term.node, term.gradient.head<3>(), term.gradient.tail<3>());
  for (const ChainRow& row : system.rows) {
    add(row.node, row.multiplier * row.v, row.multiplier * row.theta);
    add(-1, row.multiplier * row.base_v, row.multiplier * row.base_theta);
    if (row.node >= 0) w[static_cast<std::size_t>(row.node)].gradient += row.multiplier * row.u;
    w[0].gradient += row.multiplier * row.first_u;
  }
  for (const SurfaceTerm& term : system.surfaces) {
    add(term.node + 1, term.gradient.head<3>(), Vec3::Zero());
    add(term.node, Vec3::Zero(), term.gradient.segment<3>(3));
    w[static_cast<std::size_t>(term.node)].pull += term.gradient[6];
    w[static_cast<std::size_t>(term.node) + 1].pull += term.gradient[7];
  }
  for (const SurfacePoint& point : system.points) {
    add(point.node, point.gradient, point.arm.cross(point.gradient));
    w[static_cast<std::size_t>(point.node)].pull += point.slant.dot(point.gradient);
  }
  for (std::size_t i = count; i-- > 0;) {
    const Vec3 b0 = first_three(system.links[i].axis[0]), b1 = first_three(system.links[i].axis[1]);
    if (i + 1 < count) {
      w[i].force += w[i + 1].force;
      w[i].torque += w[i + 1].torque + first_three(system.links[i].span).cross(w[i + 1].force);
    }
    w[i].pull += b1.dot(w[i].torque);
    w[i].gradient += Vec2(b0.dot(w[i].torque), w[i].pull);
  }
  base_gradient.head<3>() += w[0].force;
  base_gradient.tail<3>() += w[0].torque;
}

}  // namespace wunderlich::math
