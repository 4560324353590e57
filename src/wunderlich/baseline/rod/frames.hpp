/// Frames of a rod: carried along in space from edge to edge, and in time from one shape to the next.
#pragma once

#include "wunderlich/baseline/rod/rod.hpp"

namespace wunderlich::baseline::rod {

/// The vector `a`, square to the unit vector `from`, turned by the smallest rotation that takes `from` to the unit
/// vector `to`; square to `to` and of unit length to rounding if it was. Undefined for opposite vectors.
/// @eq Bergou2008:4.2
inline Vec3 carried(const Vec3& a, const Vec3& from, const Vec3& to) {
  Vec3 b = a - a.dot(to) / (1 + from.dot(to)) * (from + to);
  b -= b.dot(to) * to;
  return b.normalized();
}

/// The two edges that a node joins. Beyond the seam of a loop the section is seen turned by `turn` [rad].
struct Joined {
  std::size_t before, after;
  std::size_t far;  ///< last node of the edge `after`
  double turn;
};
Joined joined(const Rod& rod, std::size_t node);

/// Turn from the reference direction of the edge before, carried to the edge after, to that one's own, in (-pi, pi].
double turn_between(const State& state, const Joined& edges);

/// Directions of the section of an edge: m1 normal to the strip, m2 across it, m3 along the edge.
struct Section {
  Vec3 m1, m2, m3;
};
Section section(const State& state, std::size_t edge);

/// Coordinates of a rod, and what they are called by: 4 i + c is component c of node i, 4 j + 3 the turn of edge j.
inline std::size_t coordinate_count(const Rod& rod) { return 4 * rod.edges() + 3; }

/// `from` with all coordinates increased by `share` of `increment`. Reference frames are carried along with their edges
/// (time-parallel), so that an increment of theta is the turn of the section about the tangent. Velocities are left as
/// they are in `to`. No edge may turn round by half a turn.   @eq Bergou2010
void move(const Rod& rod, const State& from, const std::vector<double>& increment, double share, State& to);

}  // namespace wunderlich::baseline::rod
