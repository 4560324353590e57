#include "wunderlich/baseline/rod/holds.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/baseline/rod/energy.hpp"
#include "wunderlich/math/banded.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::baseline::rod {

using constraint::Orientation;
using constraint::Support;

namespace {

constexpr double kRounding = 1e-13;    // over the length, or of a turn: supports that stand do not move
constexpr int kFree = -1, kHeld = -2;  // in `number`, before unknowns are counted; else: shared with that coordinate

std::size_t edge_of(const Rod& rod, const Support& support) {
  const int edge = support.segment >= 0 ? support.segment : support.node;
  return static_cast<std::size_t>(std::min(edge, rod.segments - 1));
}

void hold_coordinate(std::size_t coordinate, double increment, Unknowns& u) {
  u.number[coordinate] = kHeld;
  u.given[coordinate] = increment;
}

void hold_position(const Support& support, const Vec3& increment, Unknowns& u) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (support.hold_position[c])
      hold_coordinate(4 * static_cast<std::size_t>(support.node) + c, increment[static_cast<int>(c)], u);
  }
}

/// The edge stands at its rest length along the frame's d3, its section along d1.
void hold_edge(const Rod& rod, const State& state, const Support& support, const Quat& frame, Unknowns& u) {
  const std::size_t edge = edge_of(rod, support), node = static_cast<std::size_t>(support.node);
  const std::size_t other = node == edge ? edge + 1 : edge;
  const Vec3 along = frame * Vec3::UnitZ();
  const Vec3 offset = (other > node ? rod.rest_length[edge] : -rod.rest_length[edge]) * along;
  const Vec3 change = offset - (state.x[other] - state.x[node]);
  for (std::size_t c = 0; c < 3; ++c) {
    const bool held = support.hold_position[c];
    u.number[4 * other + c] = held ? kHeld : static_cast<int>(4 * node + c);
    u.given[4 * other + c] = change[static_cast<int>(c)] + u.given[4 * node + c];
  }
  const Section now = section(state, edge);
  const Vec3 goal = frame * Vec3::UnitX(), m1 = carried(now.m1, now.m3, along);
  hold_coordinate(4 * edge + 3, std::atan2(along.dot(m1.cross(goal)), m1.dot(goal)), u);
}

void hold_support(const Rod& rod, const State& state, const Support& support, double time, Unknowns& u) {
  const Pose pose = constraint::pose_at(support.motion, time);
  hold_position(support, pose.position - state.x[static_cast<std::size_t>(support.node)], u);
  if (support.orientation == Orientation::full) hold_edge(rod, state, support, pose.frame, u);
  if (support.orientation == Orientation::about_tangent) {
    // Frames are carried along with their edges, so that no turn at all is what holds the section's.
    const Quat before = constraint::pose_at(support.motion, state.time).frame;
    hold_coordinate(4 * edge_of(rod, support) + 3, math::log_map(before.conjugate() * pose.frame)[2], u);
  }
}

/// Keeps the first edge's first node, its direction and its turn: six coordinates without a reaction.
void anchor(const State& state, Unknowns& u) {
  Eigen::Index along = 0;
  (state.x[1] - state.x[0]).cwiseAbs().maxCoeff(&along);
  for (std::size_t c = 0; c < 4; ++c) hold_coordinate(c, 0, u);
  for (std::size_t c = 0; c < 3; ++c) {
    if (c != static_cast<std::size_t>(along)) hold_coordinate(4 + c, 0, u);
  }
}

void drop_rounding(const Rod& rod, Unknowns& u) {
  for (std::size_t c = 0; c < u.given.size(); ++c) {
    if (std::abs(u.given[c]) < kRounding * (c % 4 == 3 ? 1 : rod.length)) u.given[c] = 0;
  }
}

void count_unknowns(const Rod& rod, Unknowns& u) {
  std::vector<int> shared = u.number;
  std::fill(u.number.begin(), u.number.end(), -1);
  u.count = 0;
  const int blocks = rod.is_loop() ? rod.segments : rod.segments + 1;
  for (int place = 0; place < blocks; ++place) {
    const int block = !rod.is_loop() ? place : place % 2 == 0 ? place / 2 : blocks - 1 - (place - 1) / 2;
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t own = 4 * static_cast<std::size_t>(block) + c;
      if (own >= shared.size()) continue;
      const std::size_t source = shared[own] >= 0 ? static_cast<std::size_t>(shared[own]) : own;
      if (shared[own] == kHeld || shared[source] == kHeld) continue;
      if (u.number[source] < 0) u.number[source] = u.count++;
      u.number[own] = u.number[source];
    }
  }
}

void find_bandwidth(const Rod& rod, Unknowns& u) {
  u.bandwidth = 1;
  const auto widen = [&](const auto& coordinates) {
    int low = u.count, high = -1;
    for (std::size_t c : coordinates) {
      if (u.number[c] < 0) continue;
      low = std::min(low, u.number[c]);
      high = std::max(high, u.number[c]);
    }
    u.bandwidth = std::max(u.bandwidth, high - low);
  };
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] > 0) widen(hinge_coordinates(rod, i));
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    std::array<std::size_t, 7> edge;
    for (std::size_t c = 0; c < 7; ++c) edge[c] = 4 * j + c;
    widen(edge);
  }
}

}  // namespace

void hold(const Rod& rod, const std::vector<Support>& supports, const State& state, double time, bool anchored,
          Unknowns& u) {
  u.number.assign(coordinate_count(rod), kFree);
  u.given.assign(coordinate_count(rod), 0.0);
  bool any = false;
  for (const Support& support : supports) {
    if (time >= support.release) continue;
    hold_support(rod, state, support, time, u);
    any = true;
  }
  if (!any && anchored) anchor(state, u);
  drop_rounding(rod, u);
  count_unknowns(rod, u);
  if (rod.is_loop()) {
    for (std::size_t c = 0; c < 3; ++c) {
      u.number[4 * rod.edges() + c] = u.number[c];
      u.given[4 * rod.edges() + c] = u.given[c];
    }
  }
  find_bandwidth(rod, u);
}

bool supports_moved(const Unknowns& unknowns) {
  return std::any_of(unknowns.given.begin(), unknowns.given.end(), [](double x) { return x != 0; });
}

}  // namespace wunderlich::baseline::rod
