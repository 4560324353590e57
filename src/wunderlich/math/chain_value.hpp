/// The value function of the chain sweep and what each element of the chain does to it. Internal to math/.
#pragma once

#include <cmath>
#include <vector>

#include "wunderlich/math/chain_sweep.hpp"
#include "wunderlich/math/four.hpp"

namespace wunderlich::math::chain {

/// Constraint columns of the value function, four to a vector: rows v (3), theta (3), u (2).
/// Q is the number of vectors; -1 means known at run time only.
template <int Q>
struct Columns {
  Four value[8][Q > 0 ? Q : 1] = {};
  explicit Columns(int) {}
  static constexpr int quads() { return Q; }
  Four* row(int i) { return value[i]; }
  const Four* row(int i) const { return value[i]; }
};

template <>
struct Columns<-1> {
  int count;
  std::vector<Four> value;
  explicit Columns(int quads) : count(quads), value(8 * static_cast<std::size_t>(quads), all(0)) {}
  int quads() const { return count; }
  Four* row(int i) { return value.data() + i * count; }
  const Four* row(int i) const { return value.data() + i * count; }
};

inline void add_lane(Four* quads, int k, double x) { reinterpret_cast<double*>(quads)[k] += x; }
inline double lane(const Four* quads, int k) { return reinterpret_cast<const double*>(quads)[k]; }

/// Value function of everything beyond the joint under way, in (v, theta, u). The blocks of its symmetric Hessian are
/// kept by rows; where a row's other lanes belong to theta, its fourth is the gradient (the right-hand side).
struct Value {
  Four vv[3] = {}, vt[3] = {};           ///< rows v: v | theta and gradient
  Four tt[3] = {};                       ///< rows theta: theta and gradient
  Four uv[2] = {}, ut[2] = {};           ///< rows u: v | theta and gradient
  double z00 = 0, z01 = 0, z11 = 0;      ///< u, u
  Four force = all(0), torque = all(0);  ///< adjoint wrench: the exact gradient in the pose
  double gradient0 = 0, gradient1 = 0;   ///< exact gradient in u so far
  double pull1 = 0;                      ///< the part of it in u_1 that the torque and forces on surfaces exert
};

/// Where the sorted lists of pose terms, probe rows and constraint rows stand.
struct Cursor {
  std::size_t term, probe, row, surface = 0;
};

/// 1, or 0 where the right-hand side is a load of its own.
inline double gradient_share(const ChainSystem& system) { return system.only_load ? 0.0 : 1.0; }

template <int Q>
void add_row(const ChainRow& row, int k, double share, Value& value, Columns<Q>& columns) {
  const Four v = four(row.v), theta = four(row.theta, share * row.residual);
  for (int i = 0; i < 3; ++i) {
    add_lane(columns.row(i), k, row.v[i]);
    add_lane(columns.row(3 + i), k, row.theta[i]);
    value.vv[i] += all(row.penalty * row.v[i]) * v;
    value.vt[i] += all(row.penalty * row.v[i]) * theta;
    value.tt[i] += all(row.penalty * row.theta[i]) * theta;
  }
  add_lane(columns.row(6), k, row.u[0]);
  add_lane(columns.row(7), k, row.u[1]);
  value.force += all(row.multiplier) * four(row.v);
  value.torque += all(row.multiplier) * four(row.theta);
  value.gradient0 += row.multiplier * row.u[0];
  value.gradient1 += row.multiplier * row.u[1];
}

inline void add_pose_term(const PoseTerm& term, double share, bool geometric, Value& value) {
  for (int i = 0; i < 3; ++i) {
    value.vv[i] += four(term.hessian.block<1, 3>(i, 0).transpose());
    value.vt[i] += four(term.hessian.block<1, 3>(i, 3).transpose(), share * term.gradient[i]);
    value.tt[i] += four(term.hessian.block<1, 3>(3 + i, 3).transpose(), share * term.gradient[3 + i]);
  }
  for (int i = 0; i < 3 && geometric; ++i) value.tt[i] += four(term.geometric.row(i).transpose());
  value.force += four(term.gradient.head<3>());
  value.torque += four(term.gradient.tail<3>());
}

inline void add_turn(const TurnTerm& term, double share, bool geometric, Value& value) {
  const Four shares{1, 1, 1, share};
  for (int i = 0; i < 3; ++i) value.tt[i] += shares * term.hessian[i];
  for (int i = 0; i < 3 && geometric; ++i) value.tt[i] += term.geometric[i];
  value.torque += Four{term.hessian[0][3], term.hessian[1][3], term.hessian[2][3], 0};
}

/// Everything of a surface's term but what couples it to u_1 of the joint before.
inline void add_surface(const SurfaceTerm& term, const Mat8& hessian, double share, Value& value) {
  for (int i = 0; i < 3; ++i) {
    value.vv[i] += four(hessian.block<1, 3>(i, 0).transpose());
    value.vt[i] += four(hessian.block<1, 3>(i, 3).transpose(), share * term.gradient[i]);
    value.tt[i] += four(hessian.block<1, 3>(3 + i, 3).transpose(), share * term.gradient[3 + i]);
  }
  value.uv[1] += four(hessian.block<1, 3>(7, 0).transpose());
  value.ut[1] += four(hessian.block<1, 3>(7, 3).transpose(), share * term.gradient[7]);
  value.z11 += hessian(7, 7);
  value.gradient1 += term.gradient[7];
  value.pull1 += term.gradient[7];
  value.force += four(term.gradient.head<3>());
  value.torque += four(term.gradient.segment<3>(3));
}

/// That, once u_1 of the joint after has been eliminated.
inline void add_surface_before(const SurfaceTerm& term, const Mat8& hessian, double share, Value& value) {
  value.uv[1] += four(hessian.block<1, 3>(6, 0).transpose());
  value.ut[1] += four(hessian.block<1, 3>(6, 3).transpose(), share * term.gradient[6]);
  value.z11 += hessian(6, 6);
  value.gradient1 += term.gradient[6];
  value.pull1 += term.gradient[6];
}

/// A pose term's or row's share at its link; row k is constraint column k.
template <int Q>
void add_pose_parts(const ChainSystem& system, int node, Cursor& next, Value& value, Columns<Q>& columns) {
  for (; next.term < system.pose_terms.size() && system.pose_terms[next.term].node == node; ++next.term) {
    add_pose_term(system.pose_terms[next.term], gradient_share(system), system.geometric, value);
  }
  const auto take = [&](std::size_t index) {
    add_row(system.rows[index], static_cast<int>(index), gradient_share(system), value, columns);
  };
  const std::size_t probes = system.probe_count();
  while (next.probe < probes && system.rows[next.probe].node == node) take(next.probe++);
  while (next.row < system.rows.size() && system.rows[next.row].node == node) take(next.row++);
}

inline void add_node(const ChainLink& link, double share, Value& value) {
  const double k = link.stiffness;
  value.vv[0] += Four{k, 0, 0, 0};
  value.vv[1] += Four{0, k, 0, 0};
  value.vv[2] += Four{0, 0, k, 0};
  for (int i = 0; i < 3; ++i) value.vt[i] += last_lane(share * link.force[i]);
  value.force += link.force;
}

/// out += a[0] rows[0] + a[1] rows[1] + a[2] rows[2], over `count` vectors.
inline void add_combination(const Four& a, const Four* x, const Four* y, const Four* z, Four* out, int count) {
  const Four a0 = all(a[0]), a1 = all(a[1]), a2 = all(a[2]);
  for (int k = 0; k < count; ++k) out[k] += a0 * x[k] + a1 * y[k] + a2 * z[k];
}

/// theta_i = theta_{i-1} + axes u, and the joint's second-order terms.
template <int Q>
void pass_joint(const ChainLink& link, bool geometric, Value& value, Columns<Q>& columns) {
  const Four b0 = link.axis[0], b1 = link.axis[1], torque = value.torque;
  const Four old0 = value.ut[0], old1 = value.ut[1];
  add_combination(link.axis[0], &value.tt[0], &value.tt[1], &value.tt[2], &value.ut[0], 1);
  add_combination(link.axis[1], &value.tt[0], &value.tt[1], &value.tt[2], &value.ut[1], 1);
  value.uv[0] += lane_sums(value.vt[0] * b0, value.vt[1] * b0, value.vt[2] * b0);
  value.uv[1] += lane_sums(value.vt[0] * b1, value.vt[1] * b1, value.vt[2] * b1);
  const Four z = lane_sums((old0 + value.ut[0]) * b0, old0 * b1 + value.ut[1] * b0, (old1 + value.ut[1]) * b1);
  value.z00 += z[0];
  value.z01 += z[1];
  value.z11 += z[2];
  for (int c = 0; c < 2; ++c) {
    add_combination(link.axis[c], columns.row(3), columns.row(4), columns.row(5), columns.row(6 + c), columns.quads());
  }
  const double pull1 = dot3(b1, torque);
  value.pull1 += pull1;
  value.gradient0 += dot3(b0, torque);
  value.gradient1 += pull1;
  if (!geometric) return;
  value.z01 += dot3(torque, link.axis_01);
  value.z11 += dot3(torque, link.axis_11);
  value.ut[0] += all(0.5) * cross(b0, torque);
  value.ut[1] += all(0.5) * cross(b1, torque);
}

/// c += d x a, for rows a, c of three of `count` vectors each.
inline void add_cross_rows(const Four& d, const Four* a0, const Four* a1, const Four* a2, Four* c0, Four* c1, Four* c2,
                           int count) {
  const Four x = all(d[0]), y = all(d[1]), z = all(d[2]);
  for (int k = 0; k < count; ++k) {
    c0[k] += y * a2[k] - z * a1[k];
    c1[k] += z * a0[k] - x * a2[k];
    c2[k] += x * a1[k] - y * a0[k];
  }
}

/// v_i = v_{i-1} + theta x span, to second order.
template <int Q>
void pass_span(const Four& span, bool geometric, Value& value, Columns<Q>& columns) {
  // Congruence with [I X; 0 I], X = -[d]x: first the left factor on the rows theta, then the right one on every row.
  const Four d = span;
  add_cross_rows(span, &value.vt[0], &value.vt[1], &value.vt[2], &value.tt[0], &value.tt[1], &value.tt[2], 1);
  add_cross_rows(span, columns.row(0), columns.row(1), columns.row(2), columns.row(3), columns.row(4), columns.row(5),
                 columns.quads());
  for (int i = 0; i < 3; ++i) value.vt[i] += cross(d, value.vv[i]);
  Four t0 = value.vt[0], t1 = value.vt[1], t2 = value.vt[2];
  transpose3(t0, t1, t2);
  value.tt[0] += cross(d, t0);
  value.tt[1] += cross(d, t1);
  value.tt[2] += cross(d, t2);
  value.ut[0] += cross(d, value.uv[0]);
  value.ut[1] += cross(d, value.uv[1]);
  if (geometric) {
    const Four half_force = all(0.5) * value.force, half_span = all(0.5) * d;
    const double work = dot3(value.force, d);
    for (int i = 0; i < 3; ++i) value.tt[i] += all(span[i]) * half_force + all(value.force[i]) * half_span;
    value.tt[0] -= Four{work, 0, 0, 0};
    value.tt[1] -= Four{0, work, 0, 0};
    value.tt[2] -= Four{0, 0, work, 0};
  }
  value.torque += cross(d, value.force);
}

}  // namespace wunderlich::math::chain
