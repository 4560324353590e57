#include "wunderlich/geometry/chart.hpp"

#include <cassert>
#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::geometry {

namespace {

/// How theta of segment 0 looks across the seam: a half turn about d3 reverses d1 and d2.
Vec3 seam_axes(const Hinge& hinge) { return {hinge.flip, hinge.flip, 1}; }

/// exp(-a) p exp(b) with p the turn of the hinge, its scalar part made non-negative.
Quat turn_of(const Ribbon& ribbon, const State& state, const Hinge& hinge) {
  const auto [before, after] = hinge_frames(ribbon, state, hinge.node);
  Quat turn = before.conjugate() * after;
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  return turn;
}

Mat3 symmetric(const Mat3& m) { return 0.5 * (m + m.transpose()); }

HingeHessian logarithm_hessian(const Quat& turn, double length, const Vec3& weight) {
  const Vec3 v = math::log_map(turn);
  const Mat3 left = math::left_jacobian_inverse(v), right = left.transpose();
  const Mat3 left_change = math::left_jacobian_inverse_derivative(v, weight / length);
  const Mat3 right_change = math::right_jacobian_inverse_derivative(v, weight / length);
  return {symmetric(right_change * left), -right_change * right, symmetric(left_change * right)};
}

HingeHessian printed_hessian(const Quat& turn, double length, const Vec3& weight) {
  const Vec3 vec = turn.vec();
  const double along = weight.dot(vec);
  const Mat3 same = -along / (2 * length) * Mat3::Identity();
  const Mat3 mixed =
      (turn.w() * math::skew(weight) - along * Mat3::Identity() + vec * weight.transpose() + weight * vec.transpose()) /
      (2 * length);
  return {same, mixed, same};
}

}  // namespace

void move(const Ribbon& ribbon, const Eigen::Ref<const Eigen::VectorXd>& increment, State& state) {
  assert(increment.size() == chart_size(ribbon));
  for (int i = 0; i <= ribbon.segments; ++i) {
    const auto k = static_cast<std::size_t>(i);
    state.r[k] += increment.segment<3>(r_index(i));
    state.eta[k] += increment[eta_index(i)];
    if (i == ribbon.segments) break;
    const Vec3 theta = increment.segment<3>(theta_index(i));
    state.q[k] = (state.q[k] * math::exp_map(theta)).normalized();
  }
  if (!ribbon.clamped[0]) state.end_frame[0] = state.q.front();
  if (!ribbon.clamped[1]) state.end_frame[1] = state.q.back();
}

std::vector<Hinge> hinges(const Ribbon& ribbon) {
  std::vector<Hinge> out;
  for (int i = 0; i <= ribbon.segments; ++i) {
    const double length = ribbon.hinge_length[static_cast<std::size_t>(i)];
    if (length == 0) continue;
    Hinge hinge{i, length, i - 1, i, 1};
    if (i == ribbon.segments) {
      hinge.after = ribbon.is_loop() ? 0 : -1;
      hinge.flip = ribbon.seam_sign();
    }
    out.push_back(hinge);
  }
  return out;
}

HingeJet hinge_jet(const Ribbon& ribbon, const State& state, const Hinge& hinge, StrainMeasure measure) {
  const Quat turn = turn_of(ribbon, state, hinge);
  HingeJet jet;
  if (measure == StrainMeasure::logarithm) {
    const Vec3 v = math::log_map(turn);
    const Mat3 left = math::left_jacobian_inverse(v) / hinge.length;
    jet = {v / hinge.length, -left, left.transpose()};
  } else {
    const Mat3 right = (turn.w() * Mat3::Identity() + math::skew(turn.vec())) / hinge.length;
    jet = {turn.vec() * (2 / hinge.length), -right.transpose(), right};
  }
  jet.after = (jet.after * seam_axes(hinge).asDiagonal()).eval();
  return jet;
}

HingeHessian hinge_hessian(const Ribbon& ribbon, const State& state, const Hinge& hinge, StrainMeasure measure,
                           const Vec3& weight) {
  const Quat turn = turn_of(ribbon, state, hinge);
  HingeHessian h = measure == StrainMeasure::logarithm ? logarithm_hessian(turn, hinge.length, weight)
                                                       : printed_hessian(turn, hinge.length, weight);
  const Vec3 axes = seam_axes(hinge);
  h.before_after = (h.before_after * axes.asDiagonal()).eval();
  h.after_after = (axes.asDiagonal() * h.after_after * axes.asDiagonal()).eval();
  return h;
}

}  // namespace wunderlich::geometry
