/// The value function of the chain sweep and what each element of the chain does to it. Internal to math/.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::math::chain {

// The inner loops work on plain arrays with extents known to the compiler: it unrolls and vectorises them, and
// nothing is allocated. M is the number of right-hand sides (gradient and rows); 0 means known at run time only.

/// Right-hand sides of the value function: rows v (3), theta (3), u (2).
template <int M>
struct Columns {
  alignas(16) double value[8][M];
  explicit Columns(int) { std::fill(&value[0][0], &value[0][0] + 8 * M, 0.0); }
  static constexpr int count() { return M; }
  double* row(int i) { return value[i]; }
  const double* row(int i) const { return value[i]; }
};

template <>
struct Columns<0> {
  int columns;
  std::vector<double> value;
  explicit Columns(int m) : columns(m), value(8 * static_cast<std::size_t>(m), 0.0) {}
  int count() const { return columns; }
  double* row(int i) { return value.data() + i * columns; }
  const double* row(int i) const { return value.data() + i * columns; }
};

/// Gram matrix of the right-hand sides in the inverse Hessian.
template <int M>
struct GramOf {
  static constexpr int size = M == 0 ? Eigen::Dynamic : M;
  using Type = Eigen::Matrix<double, size, size, M == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
};

/// Value function of everything beyond the joint under way, in (v, theta, u).
struct Value {
  double p[6][6] = {};                               ///< pose, pose
  double y[6][2] = {};                               ///< pose, u
  Mat2 z = Mat2::Zero();                             ///< u, u
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< adjoint wrench: the exact gradient in the pose
  Vec2 gradient = Vec2::Zero();                      ///< exact gradient in u so far
};

inline int negative_count(const Mat2& z) {
  const double det = z(0, 0) * z(1, 1) - z(0, 1) * z(1, 0);
  if (det < 0) return 1;
  return z(0, 0) + z(1, 1) < 0 ? 2 : 0;
}

inline bool invert(const Mat2& z, Mat2& inverse) {
  const double det = z(0, 0) * z(1, 1) - z(0, 1) * z(1, 0);
  if (det == 0 || !std::isfinite(det)) return false;
  const double f = 1 / det;
  inverse << f * z(1, 1), -f * z(0, 1), -f * z(1, 0), f * z(0, 0);
  return true;
}

/// Where the sorted lists of pose terms, probe rows and constraint rows stand.
struct Cursor {
  std::size_t term, probe, row;
};

/// 1, or 0 where the right-hand side is a load of its own.
inline double gradient_share(const ChainSystem& system) { return system.only_load ? 0.0 : 1.0; }

template <int M>
void add_row(const ChainRow& row, int k, double share, Value& value, Columns<M>& columns) {
  const double pose[6] = {row.v[0], row.v[1], row.v[2], row.theta[0], row.theta[1], row.theta[2]};
  for (int i = 0; i < 6; ++i) {
    columns.row(i)[k] = pose[i];
    columns.row(i)[0] += share * row.penalty * row.residual * pose[i];
    for (int j = 0; j < 6; ++j) value.p[i][j] += row.penalty * pose[i] * pose[j];
  }
  columns.row(6)[k] = row.u[0];
  columns.row(7)[k] = row.u[1];
  value.force += row.multiplier * row.v;
  value.torque += row.multiplier * row.theta;
  value.gradient += row.multiplier * row.u;
}

/// A pose term's or row's share at its link; row k is column k + 1.
template <int M>
void add_pose_parts(const ChainSystem& system, int node, Cursor& next, Value& value, Columns<M>& columns) {
  for (; next.term < system.pose_terms.size() && system.pose_terms[next.term].node == node; ++next.term) {
    const PoseTerm& term = system.pose_terms[next.term];
    for (int i = 0; i < 6; ++i) {
      columns.row(i)[0] += gradient_share(system) * term.gradient[i];
      for (int j = 0; j < 6; ++j) value.p[i][j] += term.hessian(i, j);
    }
    value.force += term.gradient.head<3>();
    value.torque += term.gradient.tail<3>();
  }
  const auto take = [&](std::size_t index) {
    add_row(system.rows[index], static_cast<int>(index) + 1, gradient_share(system), value, columns);
  };
  const std::size_t probes = system.probe_count();
  while (next.probe < probes && system.rows[next.probe].node == node) take(next.probe++);
  while (next.row < system.rows.size() && system.rows[next.row].node == node) take(next.row++);
}

inline void add_node(const ChainLink& link, double share, Value& value, double* v0, double* v1, double* v2) {
  for (int i = 0; i < 3; ++i) value.p[i][i] += link.stiffness;
  v0[0] += share * link.force[0];
  v1[0] += share * link.force[1];
  v2[0] += share * link.force[2];
  value.force += link.force;
}

/// theta_i = theta_{i-1} + axes u, and the joint's second-order terms.
template <int M>
void pass_joint(const ChainLink& link, bool geometric, Value& value, Columns<M>& columns) {
  const Mat32 b = link.axes;  // a copy: what is written below could alias it
  value.gradient.noalias() += b.transpose() * value.torque;
  for (int c = 0; c < 2; ++c) {
    const double b0 = b(0, c), b1 = b(1, c), b2 = b(2, c);
    double* u = columns.row(6 + c);
    const double *t0 = columns.row(3), *t1 = columns.row(4), *t2 = columns.row(5);
    for (int k = 0; k < columns.count(); ++k) u[k] += b0 * t0[k] + b1 * t1[k] + b2 * t2[k];
  }
  double pb[6][2];
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 2; ++c) pb[i][c] = value.p[i][3] * b(0, c) + value.p[i][4] * b(1, c) + value.p[i][5] * b(2, c);
  }
  for (int c = 0; c < 2; ++c) {
    for (int e = 0; e < 2; ++e) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        sum += b(k, c) * (value.y[3 + k][e] + pb[3 + k][e]) + value.y[3 + k][c] * b(k, e);
      }
      value.z(c, e) += sum;
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 2; ++c) value.y[i][c] += pb[i][c];
  }
  if (!geometric) return;
  const double z01 = value.torque.dot(link.axes_01);
  value.z(0, 1) += z01;
  value.z(1, 0) += z01;
  value.z(1, 1) += value.torque.dot(link.axes_11);
  for (int c = 0; c < 2; ++c) {
    const Vec3 half = 0.5 * b.col(c).cross(value.torque);
    for (int k = 0; k < 3; ++k) value.y[3 + k][c] += half[k];
  }
}

/// rows 3..5 += d x rows 0..2, over `count` entries. The rows do not overlap; the compiler cannot know.
inline void cross_rows(Vec3 d, const double* __restrict v0, const double* __restrict v1, const double* __restrict v2,
                       double* __restrict t0, double* __restrict t1, double* __restrict t2, int count) {
  const double x = d[0], y = d[1], z = d[2];
  for (int k = 0; k < count; ++k) {
    t0[k] += y * v2[k] - z * v1[k];
    t1[k] += z * v0[k] - x * v2[k];
    t2[k] += x * v1[k] - y * v0[k];
  }
}

/// v_i = v_{i-1} + theta x span, to second order.
template <int M>
void pass_span(Vec3 d, bool geometric, Value& value, Columns<M>& columns) {
  // Congruence with [I X; 0 I], X = -[d]x: first the right factor on every row, then the left one on every column.
  auto& p = value.p;
  for (int i = 0; i < 6; ++i) {
    p[i][3] += d[1] * p[i][2] - d[2] * p[i][1];
    p[i][4] += d[2] * p[i][0] - d[0] * p[i][2];
    p[i][5] += d[0] * p[i][1] - d[1] * p[i][0];
  }
  cross_rows(d, p[0], p[1], p[2], p[3], p[4], p[5], 6);
  cross_rows(d, value.y[0], value.y[1], value.y[2], value.y[3], value.y[4], value.y[5], 2);
  cross_rows(d, columns.row(0), columns.row(1), columns.row(2), columns.row(3), columns.row(4), columns.row(5),
             columns.count());
  if (geometric) {
    const double work = value.force.dot(d);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) p[3 + i][3 + j] += 0.5 * (d[i] * value.force[j] + d[j] * value.force[i]);
      p[3 + i][3 + i] -= work;
    }
  }
  value.torque += d.cross(value.force);
}

}  // namespace wunderlich::math::chain
