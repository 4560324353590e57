#include "wunderlich/constraint/holding.hpp"

#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::constraint {

using geometry::add_block;
using geometry::eta_index;
using geometry::r_index;
using geometry::Ribbon;
using geometry::State;
using geometry::theta_index;

namespace {

bool straight_ends(const Ribbon& ribbon) { return !ribbon.is_loop() && !ribbon.free_rulings; }

Quat turn_from(const Quat& reference, const State& state, int segment) {
  return reference.conjugate() * state.q[static_cast<std::size_t>(segment)];
}

/// The turn p = (smallest rotation) (rotation about e3 by `angle`): the angle's derivatives in theta.
struct TurnAngle {
  double angle;
  Vec3 gradient;
  Mat3 hessian;
};

TurnAngle turn_about_tangent(Quat p) {
  if (p.w() < 0) p.coeffs() = -p.coeffs();
  const double x = p.x(), y = p.y(), z = p.z(), w = p.w(), n = z * z + w * w;
  const Vec3 dz(0.5 * -y, 0.5 * x, 0.5 * w), dw(0.5 * -x, 0.5 * -y, 0.5 * -z);
  // angle = 2 atan2(z, w). Second derivatives of p along exp(theta) are -p |theta|^2/4 and drop out.
  const double zz = -4 * z * w / (n * n), zw = 2 * (z * z - w * w) / (n * n);
  const Mat3 mixed = dz * dw.transpose();
  return {2 * std::atan2(z, w), (2 / n) * (w * dz - z * dw),
          zz * (dz * dz.transpose() - dw * dw.transpose()) + zw * (mixed + mixed.transpose())};
}

}  // namespace

Quat transported(const Quat& frame, const Vec3& tangent) {
  return (math::shortest_rotation(frame * Vec3::UnitZ(), tangent) * frame).normalized();
}

int rows(const Ribbon&, const Pin& c) { return c.axes[0] + c.axes[1] + c.axes[2]; }

void residual(const Ribbon&, const Pin& c, const State& state, ResidualRef out) {
  const Vec3 away = state.r[static_cast<std::size_t>(c.node)] - c.position;
  int row = 0;
  for (int k = 0; k < 3; ++k) {
    if (c.axes[static_cast<std::size_t>(k)]) out[row++] = away[k];
  }
}

void add_jacobian(const Ribbon&, const Pin& c, const State&, int first_row, Triplets& out) {
  for (int k = 0; k < 3; ++k) {
    if (c.axes[static_cast<std::size_t>(k)]) out.emplace_back(first_row++, r_index(c.node) + k, 1.0);
  }
}

void add_hessian(const Ribbon&, const Pin&, const State&, MultiplierRef, Triplets&) {}  // linear

int rows(const Ribbon&, const FrameClamp&) { return 3; }

void residual(const Ribbon&, const FrameClamp& c, const State& state, ResidualRef out) {
  out = math::log_map(turn_from(c.frame, state, c.segment));
}

void add_jacobian(const Ribbon&, const FrameClamp& c, const State& state, int first_row, Triplets& out) {
  const Vec3 turn = math::log_map(turn_from(c.frame, state, c.segment));
  add_block(first_row, theta_index(c.segment), math::right_jacobian_inverse(turn), out);
}

void add_hessian(const Ribbon&, const FrameClamp& c, const State& state, MultiplierRef multiplier, Triplets& out) {
  const Vec3 turn = math::log_map(turn_from(c.frame, state, c.segment));
  const Mat3 second = math::left_jacobian_inverse_derivative(turn, multiplier) * math::right_jacobian_inverse(turn);
  add_block(theta_index(c.segment), theta_index(c.segment), 0.5 * (second + second.transpose()), out);
}

int rows(const Ribbon&, const TangentTurn&) { return 1; }

void residual(const Ribbon&, const TangentTurn& c, const State& state, ResidualRef out) {
  out[0] = turn_about_tangent(turn_from(c.frame, state, c.segment)).angle;
}

void add_jacobian(const Ribbon&, const TangentTurn& c, const State& state, int first_row, Triplets& out) {
  const TurnAngle turn = turn_about_tangent(turn_from(c.frame, state, c.segment));
  add_block(first_row, theta_index(c.segment), turn.gradient.transpose(), out);
}

void add_hessian(const Ribbon&, const TangentTurn& c, const State& state, MultiplierRef multiplier, Triplets& out) {
  const TurnAngle turn = turn_about_tangent(turn_from(c.frame, state, c.segment));
  add_block(theta_index(c.segment), theta_index(c.segment), multiplier[0] * turn.hessian, out);
}

int rows(const Ribbon& ribbon, const EndRulings&) { return straight_ends(ribbon) ? 2 : 0; }

void residual(const Ribbon& ribbon, const EndRulings&, const State& state, ResidualRef out) {
  if (straight_ends(ribbon)) out << state.eta.front(), state.eta.back();
}

void add_jacobian(const Ribbon& ribbon, const EndRulings&, const State&, int first_row, Triplets& out) {
  if (!straight_ends(ribbon)) return;
  out.emplace_back(first_row, eta_index(0), 1.0);
  out.emplace_back(first_row + 1, eta_index(ribbon.segments), 1.0);
}

void add_hessian(const Ribbon&, const EndRulings&, const State&, MultiplierRef, Triplets&) {}  // linear

int rows(const Ribbon& ribbon, const LoopClosure&) { return ribbon.is_loop() ? 4 : 0; }

void residual(const Ribbon& ribbon, const LoopClosure&, const State& state, ResidualRef out) {
  if (!ribbon.is_loop()) return;
  out << state.r.back() - state.r.front(), state.eta.back() - ribbon.seam_sign() * state.eta.front();
}

void add_jacobian(const Ribbon& ribbon, const LoopClosure&, const State&, int first_row, Triplets& out) {
  if (!ribbon.is_loop()) return;
  const int last = ribbon.segments;
  for (int k = 0; k < 3; ++k) {
    out.emplace_back(first_row + k, r_index(0) + k, -1.0);
    out.emplace_back(first_row + k, r_index(last) + k, 1.0);
  }
  out.emplace_back(first_row + 3, eta_index(0), -ribbon.seam_sign());
  out.emplace_back(first_row + 3, eta_index(last), 1.0);
}

void add_hessian(const Ribbon&, const LoopClosure&, const State&, MultiplierRef, Triplets&) {}  // linear

}  // namespace wunderlich::constraint
