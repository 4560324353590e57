#include "wunderlich/solver/load_step.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/by_node.hpp"

namespace wunderlich::solver {

using constraint::Orientation;
using constraint::Support;
using geometry::Chain;
using geometry::Ribbon;

namespace {

bool is_base(const Ribbon& ribbon, const Support& support) {
  return !ribbon.is_loop() && support.node == 0 && support.orientation != Orientation::about_tangent &&
         (support.segment < 0 || support.orientation == Orientation::free);
}

/// A support's pose at path parameter t; during the approach on the way from the strip's own pose to that at time 0.
Pose pose_of(const PathProblem& path, const PathState& state, std::size_t index, double t) {
  const constraint::Motion& motion = path.surroundings.supports[index].motion;
  if (state.phase != Phase::approach) return constraint::pose_at(motion, t);
  const Pose goal = constraint::pose_at(motion, 0);
  const Pose& origin = state.origin[index];
  return {origin.position + t * (goal.position - origin.position), origin.frame.slerp(t, goal.frame)};
}

Hold hold_at(const PathProblem& path, const PathState& state, std::size_t index, double t) {
  const Support& support = path.surroundings.supports[index];
  Hold hold;
  hold.node = held_link(support);
  hold.position = support.hold_position;
  hold.orientation = support.orientation;
  hold.on_base = support.orientation == Orientation::about_tangent && holds_base_frame(path.ribbon, support);
  if (!path.ribbon.is_loop() && support.node == 0) hold.end = 0;
  if (!path.ribbon.is_loop() && support.node == path.ribbon.segments) hold.end = 1;
  hold.target = pose_of(path, state, index, t);
  if (support.orientation == Orientation::about_tangent) {
    // Held against the frame of the last step, carried along with the tangent and turned by what the motion asks.
    const double last = state.phase == Phase::settle ? t : state.t;
    const Quat before = pose_of(path, state, index, last).frame;
    const Vec3 turn = math::log_map(before.conjugate() * hold.target.frame);
    hold.target.frame = state.transported[index] * math::exp_map(Vec3(0, 0, turn[2]));
  }
  return hold;
}

/// A support's rows: position at its node, frame at its link; apart where these differ (the end of the last segment).
void add_holds(const Support& support, Hold hold, ChainProblem& problem) {
  if (support.node != hold.node) {
    Hold position = hold;
    position.node = support.node;
    position.orientation = Orientation::free;
    insert_by_node(position, problem.holds);
    hold.position.fill(false);
  }
  insert_by_node(hold, problem.holds);
}

void fix_base(const Support& support, const Pose& pose, ChainProblem& problem, Chain& chain) {
  for (int c = 0; c < 3; ++c) {
    const bool held = support.hold_position[static_cast<std::size_t>(c)];
    problem.base_fixed[static_cast<std::size_t>(c)] = held;
    if (held) chain.base.position[c] = pose.position[c];
  }
  const bool clamped = support.orientation == Orientation::full;
  for (std::size_t c = 3; c < 6; ++c) problem.base_fixed[c] = clamped;
  if (clamped) chain.base.frame = pose.frame;
}

void add_loads(const PathProblem& path, const PathState& state, double t, ChainProblem& problem) {
  const bool approach = state.phase == Phase::approach;
  const double share = approach ? t : 1;
  for (std::size_t i = 0; i < problem.force.size(); ++i) {
    problem.force[i] = share * path.ribbon.node_mass[i] * path.surroundings.gravity;
  }
  for (const constraint::Load& load : path.surroundings.loads) {
    constraint::LoadKey key = constraint::load_at(load, approach ? 0 : t);
    key.force *= share;
    key.torque *= share;
    if (load.frame == constraint::LoadFrame::space && key.torque.isZero()) {
      problem.force[static_cast<std::size_t>(load.node)] += key.force;
    } else {
      const bool on_base = load.node == 0 && path.ribbon.clamped[0];
      insert_by_node(PointLoad{on_base ? -1 : load.node, load.frame, key.force, key.torque}, problem.loads);
    }
  }
}

void add_grips(const std::vector<constraint::Grip>& grips, std::vector<GripTie>& ties) {
  ties.clear();
  for (const constraint::Grip& grip : grips) {
    const Mat3 frame = grip.target.frame.toRotationMatrix();
    GripTie tie{grip.segment, {}};
    tie.tie.weight.diagonal() << grip.stiffness, grip.turn_stiffness, grip.turn_stiffness;
    tie.tie.anchor << grip.target.position, frame.col(2), frame.col(1);
    ties.push_back(tie);
  }
}

}  // namespace

bool holds_base_frame(const Ribbon& ribbon, const Support& support) {
  return ribbon.clamped[0] && support.node == 0 && support.segment < 0;
}

int held_link(const Support& support) { return support.segment >= 0 ? support.segment : support.node; }

bool base_is_held(const PathProblem& path) {
  const auto& supports = path.surroundings.supports;
  return std::any_of(supports.begin(), supports.end(), [&](const Support& s) { return is_base(path.ribbon, s); });
}

double motion_between(const PathProblem& path, double t0, double t1) {
  double most = 0;
  for (const Support& support : path.surroundings.supports) {
    double way = 0;
    const auto& keys = support.motion.keys;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
      const double span = keys[i + 1].time - keys[i].time;
      const double inside = std::min(t1, keys[i + 1].time) - std::max(t0, keys[i].time);
      if (inside <= 0) continue;
      const double turned =
          std::abs(keys[i + 1].turn - keys[i].turn) + keys[i].pose.frame.angularDistance(keys[i + 1].pose.frame);
      const double moved = (keys[i + 1].pose.position - keys[i].pose.position).norm() / path.ribbon.length;
      way += inside / span * std::max(turned, moved);
    }
    most = std::max(most, way);
  }
  return most;
}

void problem_at(const PathProblem& path, const PathState& state, double t, Chain& chain, ChainProblem& problem) {
  const Ribbon& ribbon = ribbon_of(path, state);
  problem.model = path.options.model;
  problem.barrier = path.options.barrier;
  problem.force.assign(static_cast<std::size_t>(ribbon.node_count()), Vec3::Zero());
  problem.loads.clear();
  problem.holds.clear();
  problem.closed = state.closed;
  const auto& supports = path.surroundings.supports;
  // A strip that nothing holds is held at its base: its shape does not depend on where it is.
  problem.base_fixed.fill(supports.empty());
  for (std::size_t i = 0; i < supports.size(); ++i) {
    if (is_base(ribbon, supports[i])) {
      fix_base(supports[i], pose_of(path, state, i, t), problem, chain);
    } else {
      add_holds(supports[i], hold_at(path, state, i, t), problem);
    }
  }
  add_loads(path, state, t, problem);
  add_grips(path.surroundings.grips, problem.grips);
  place_solids(ribbon, path.surroundings, state.phase == Phase::approach ? 0 : t, problem.contact);
  place_self(path.ribbon, path.surroundings, path.surroundings.contact.distance, state.closed, state.chain.eta,
             problem.self);
}

}  // namespace wunderlich::solver
