#include "wunderlich/baseline/rod/frames.hpp"

#include <cmath>
#include <numbers>

namespace wunderlich::baseline::rod {

namespace {

using std::numbers::pi;

Vec3 tangent(const State& state, std::size_t edge) { return (state.x[edge + 1] - state.x[edge]).normalized(); }

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

}  // namespace

Joined joined(const Rod& rod, std::size_t node) {
  if (node < rod.edges()) return {node - 1, node, node + 1, 0};
  return {rod.edges() - 1, 0, 1, pi * rod.half_twists};
}

double turn_between(const State& state, const Joined& edges) {
  const Vec3 after = tangent(state, edges.after);
  return angle_about(after, carried(state.reference[edges.before], tangent(state, edges.before), after),
                     state.reference[edges.after]);
}

Section section(const State& state, std::size_t edge) {
  const Vec3 m3 = tangent(state, edge), a = state.reference[edge], b = m3.cross(a);
  const double c = std::cos(state.theta[edge]), s = std::sin(state.theta[edge]);
  return {c * a + s * b, c * b - s * a, m3};
}

void move(const Rod& rod, const State& from, const std::vector<double>& increment, double share, State& to) {
  to.time = from.time;
  to.x.resize(from.x.size());
  to.theta.resize(from.theta.size());
  to.reference.resize(from.reference.size());
  to.reference_twist.resize(from.reference_twist.size());
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    to.x[i] = from.x[i] + share * Vec3(increment[4 * i], increment[4 * i + 1], increment[4 * i + 2]);
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    to.theta[j] = from.theta[j] + share * increment[4 * j + 3];
    to.reference[j] = carried(from.reference[j], tangent(from, j), tangent(to, j));
  }
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const double change = turn_between(to, joined(rod, i)) - from.reference_twist[i];
    to.reference_twist[i] = from.reference_twist[i] + change - 2 * pi * std::round(change / (2 * pi));
  }
}

}  // namespace wunderlich::baseline::rod
