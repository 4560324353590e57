#include "wunderlich/geometry/state.hpp"

#include <cassert>
#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::geometry {

namespace {

/// Columns d1 = +z, d2 = -y, d3 = +x.
Quat straight_frame() {
  Mat3 columns;
  columns << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  return Quat(columns);
}

/// A frame at the end of a loop, seen from the start: the inverse of `across_seam`.
Quat back_across_seam(const Ribbon& ribbon, const Quat& frame) {
  return ribbon.half_twists % 2 == 0 ? frame : frame * Quat(0, 0, 0, -1);
}

/// The frame where two neighbouring segments of lengths `before` and `after` meet.
Quat frame_between(const Quat& a, const Quat& b, double before, double after) {
  const Vec3 turn = math::log_map(a.conjugate() * b);
  return (a * math::exp_map(turn * (before / (before + after)))).normalized();
}

}  // namespace

State straight_state(const Ribbon& ribbon) {
  const auto segments = static_cast<std::size_t>(ribbon.segments);
  State state;
  state.r.reserve(segments + 1);
  for (double u : ribbon.node_u) state.r.emplace_back(u, 0, 0);
  state.r_dot.assign(segments + 1, Vec3::Zero());
  state.q.assign(segments, straight_frame());
  state.eta.assign(segments + 1, 0.0);
  state.end_frame = {straight_frame(), straight_frame()};
  return state;
}

Vec3 hinge_strain(const Quat& before, const Quat& after, double hinge_length, StrainMeasure measure) {
  const Quat turn = before.conjugate() * after;
  if (measure == StrainMeasure::logarithm) return math::log_map(turn) / hinge_length;
  return turn.vec() * (std::copysign(2.0, turn.w()) / hinge_length);
}

std::array<Quat, 2> hinge_frames(const Ribbon& ribbon, const State& state, int node) {
  const auto i = static_cast<std::size_t>(node);
  assert(ribbon.hinge_length[i] > 0);
  if (node == 0) return {state.end_frame[0], state.q.front()};
  if (node < ribbon.segments) return {state.q[i - 1], state.q[i]};
  return {state.q.back(), ribbon.is_loop() ? across_seam(ribbon, state.q.front()) : state.end_frame[1]};
}

Strains strains(const Ribbon& ribbon, const State& state, StrainMeasure measure) {
  const auto segments = static_cast<std::size_t>(ribbon.segments);
  Strains out;
  out.gamma.assign(segments + 1, 0.0);
  out.kappa.assign(segments + 1, 0.0);
  out.tau.assign(segments + 1, 0.0);
  for (std::size_t i = 0; i <= segments; ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const auto [before, after] = hinge_frames(ribbon, state, static_cast<int>(i));
    const Vec3 u = hinge_strain(before, after, ribbon.hinge_length[i], measure);
    out.gamma[i] = u[0];
    out.kappa[i] = u[1];
    out.tau[i] = u[2];
  }
  if (ribbon.is_loop()) {
    out.gamma[0] = ribbon.seam_sign() * out.gamma[segments];
    out.kappa[0] = ribbon.seam_sign() * out.kappa[segments];
    out.tau[0] = out.tau[segments];
  }
  out.eta_prime.resize(segments);
  out.ruling_ratio.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    out.eta_prime[s] = (state.eta[s + 1] - state.eta[s]) / ribbon.rest_length[s];
    out.ruling_ratio[s] = 0.5 * ribbon.width * out.eta_prime[s];
  }
  return out;
}

Quat node_frame(const Ribbon& ribbon, const State& state, int node) {
  const auto i = static_cast<std::size_t>(node);
  const auto& l = ribbon.rest_length;
  if (node > 0 && node < ribbon.segments) return frame_between(state.q[i - 1], state.q[i], l[i - 1], l[i]);
  if (ribbon.is_loop()) {
    if (node == 0) {
      return frame_between(back_across_seam(ribbon, state.q.back()), state.q.front(), l.back(), l.front());
    }
    return frame_between(state.q.back(), across_seam(ribbon, state.q.front()), l.back(), l.front());
  }
  if (node == 0) return ribbon.clamped[0] ? state.end_frame[0] : state.q.front();
  return ribbon.clamped[1] ? state.end_frame[1] : state.q.back();
}

}  // namespace wunderlich::geometry
