#include "wunderlich/baseline/rod/followers.hpp"

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::baseline::rod {

namespace {

/// A vector in space and how it changes with its edge's section.
struct Carried {
  Vec3 value;
  Vec3 by_turn;
  Mat3 by_edge;
};

/// The section turns by m3 dtheta + m3 x de/|e|.
Carried carried_by(const Section& s, double over, bool turns, const Vec3& components) {
  if (!turns) return {components, Vec3::Zero(), Mat3::Zero()};
  const Vec3 v = components.x() * s.m1 + components.y() * s.m2 + components.z() * s.m3;
  return {v, s.m3.cross(v), -over * math::skew(v) * math::skew(s.m3)};
}

}  // namespace

FollowerTerms follower_terms(const State& state, const Follower& load) {
  const Section s = section(state, load.edge);
  const double over = 1 / (state.x[load.edge + 1] - state.x[load.edge]).norm();
  const Mat3 across = Mat3::Identity() - s.m3 * s.m3.transpose();
  const Carried force = carried_by(s, over, load.turns, load.force);
  const Carried torque = carried_by(s, over, load.turns, load.torque);
  // What turns the edge is a couple on its nodes: torque x m3/|e| on the second, its opposite on the first.
  const Vec3 couple = over * torque.value.cross(s.m3);
  const double twisting = torque.value.dot(s.m3);
  const Vec3 couple_by_turn = over * torque.by_turn.cross(s.m3);
  // An increment of theta is the turn about the tangent only from where frames are carried from: two increments in
  // turn enclose a solid angle, half of m3 . (de x de)/|e|^2.
  const Mat3 couple_by_edge = over * (over * math::skew(torque.value) * across - math::skew(s.m3) * torque.by_edge) -
                              over * couple * s.m3.transpose() - 0.5 * over * over * twisting * math::skew(s.m3);

  FollowerTerms terms;
  terms.force << -couple, twisting, couple;
  terms.derivative << couple_by_edge, -couple_by_turn, -couple_by_edge,  //
      -(s.m3.transpose() * torque.by_edge + over * torque.value.transpose() * across), s.m3.dot(torque.by_turn),
      s.m3.transpose() * torque.by_edge + over * torque.value.transpose() * across,  //
      -couple_by_edge, couple_by_turn, couple_by_edge;
  const int row = load.node == load.edge ? 0 : 4;
  terms.force.segment<3>(row) += force.value;
  terms.derivative.block<3, 3>(row, 0) -= force.by_edge;
  terms.derivative.block<3, 1>(row, 3) += force.by_turn;
  terms.derivative.block<3, 3>(row, 4) += force.by_edge;
  return terms;
}

}  // namespace wunderlich::baseline::rod
