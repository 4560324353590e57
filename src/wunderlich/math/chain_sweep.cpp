#include "wunderlich/math/chain_sweep.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace wunderlich::math {

namespace {

/// Columns kept on the stack for the usual constraint counts; 0 means "known at run time only".
template <int M>
struct Columns {
  static constexpr int count = M == 0 ? Eigen::Dynamic : M;
  static constexpr int order = M == 1 ? Eigen::ColMajor : Eigen::RowMajor;
  using Block = Eigen::Matrix<double, 8, count, order>;
  using Pair = Eigen::Matrix<double, 2, count, order>;
  using Gram = Eigen::Matrix<double, count, count, order>;
};

/// Value function of everything beyond the joint under way, in (v, theta, u).
struct Value {
  Mat6 p = Mat6::Zero();                                                ///< pose, pose
  Eigen::Matrix<double, 6, 2> y = Eigen::Matrix<double, 6, 2>::Zero();  ///< pose, u
  Mat2 z = Mat2::Zero();                                                ///< u, u
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< adjoint wrench: the exact gradient in the pose
  Vec2 gradient = Vec2::Zero();                      ///< exact gradient in u so far
};

int negative_count(const Mat2& z) {
  const double det = z(0, 0) * z(1, 1) - z(0, 1) * z(1, 0);
  if (det < 0) return 1;
  return z(0, 0) + z(1, 1) < 0 ? 2 : 0;
}

bool invert(const Mat2& z, Mat2& inverse) {
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

/// A pose term's or row's share at its link; row k is column k + 1.
template <class Block>
void add_pose_parts(const ChainSystem& system, int node, Cursor& next, Value& value, Block& columns) {
  for (; next.term < system.pose_terms.size() && system.pose_terms[next.term].node == node; ++next.term) {
    const PoseTerm& term = system.pose_terms[next.term];
    value.p += term.hessian;
    columns.col(0).template head<6>() += term.gradient;
    value.force += term.gradient.head<3>();
    value.torque += term.gradient.tail<3>();
  }
  const auto take = [&](std::size_t index) {
    const ChainRow& row = system.rows[index];
    Vec6 pose;
    pose << row.v, row.theta;
    const auto k = static_cast<Eigen::Index>(index) + 1;
    columns.col(k).template head<6>() = pose;
    columns.col(k).template tail<2>() = row.u;
    value.p += row.penalty * pose * pose.transpose();
    columns.col(0).template head<6>() += row.penalty * row.residual * pose;
    value.force += row.multiplier * row.v;
    value.torque += row.multiplier * row.theta;
    value.gradient += row.multiplier * row.u;
  };
  const std::size_t probes = system.probe_count();
  while (next.probe < probes && system.rows[next.probe].node == node) take(next.probe++);
  while (next.row < system.rows.size() && system.rows[next.row].node == node) take(next.row++);
}

/// theta_i = theta_{i-1} + axes u, and the joint's second-order terms.
template <class Block>
void pass_joint(const ChainLink& link, bool geometric, Value& value, Block& columns) {
  const Mat32& b = link.axes;
  value.gradient.noalias() += b.transpose() * value.torque;
  columns.template bottomRows<2>() += (b.transpose() * columns.template middleRows<3>(3)).eval();
  const Eigen::Matrix<double, 6, 2> pb = value.p.template rightCols<3>() * b;
  const Mat2 by = b.transpose() * value.y.template bottomRows<3>();
  value.z += by + by.transpose();
  value.z.noalias() += b.transpose() * pb.template bottomRows<3>();
  value.y += pb;
  if (geometric) {
    const double z01 = value.torque.dot(link.axes_01);
    value.z(0, 1) += z01;
    value.z(1, 0) += z01;
    value.z(1, 1) += value.torque.dot(link.axes_11);
    value.y.template bottomRows<3>().col(0) += 0.5 * b.col(0).cross(value.torque);
    value.y.template bottomRows<3>().col(1) += 0.5 * b.col(1).cross(value.torque);
  }
}

/// v_i = v_{i-1} + theta x span, to second order.
template <class Block>
void pass_span(const Vec3& d, bool geometric, Value& value, Block& columns) {
  // Congruence with [I X; 0 I], X = -[d]x: first the right factor on every row, then the left one on every column.
  for (int i = 0; i < 6; ++i) {
    const Vec3 row = value.p.template block<1, 3>(i, 0).transpose();
    value.p.template block<1, 3>(i, 3) += d.cross(row).transpose();
  }
  for (int j = 0; j < 6; ++j) {
    const Vec3 column = value.p.template block<3, 1>(0, j);
    value.p.template block<3, 1>(3, j) += d.cross(column);
  }
  for (int j = 0; j < 2; ++j) {
    const Vec3 column = value.y.template block<3, 1>(0, j);
    value.y.template block<3, 1>(3, j) += d.cross(column);
  }
  const auto v0 = columns.row(0).eval(), v1 = columns.row(1).eval(), v2 = columns.row(2).eval();
  columns.row(3) += d[1] * v2 - d[2] * v1;
  columns.row(4) += d[2] * v0 - d[0] * v2;
  columns.row(5) += d[0] * v1 - d[1] * v0;
  if (geometric) {
    const Mat3 outer = d * value.force.transpose();
    value.p.template block<3, 3>(3, 3) += 0.5 * (outer + outer.transpose());
    value.p.template block<3, 3>(3, 3).diagonal().array() -= value.force.dot(d);
  }
  value.torque += d.cross(value.force);
}

/// Loads without a potential: their rows are probes y = row . x with multiplier follower * y, solved together with
/// the constraints. The probes come first.
template <class Gram>
bool solve_with_followers(const ChainSystem& system, const Gram& gram, ChainStep& step) {
  const auto m = static_cast<Eigen::Index>(system.rows.size());
  const Eigen::Index probes = system.follower.rows();
  const Eigen::MatrixXd schur = gram.bottomRightCorner(m, m);
  Eigen::VectorXd rhs = -gram.col(0).tail(m);
  // probes: (1 + K T) lambda = K rhs;   constraints: T lambda = residual + rhs
  Eigen::MatrixXd matrix = schur;
  matrix.topRows(probes) = system.follower * schur.topRows(probes);
  matrix.topLeftCorner(probes, probes).diagonal().array() += 1;
  rhs.head(probes) = (system.follower * rhs.head(probes)).eval();
  for (Eigen::Index k = probes; k < m; ++k) rhs[k] += system.rows[static_cast<std::size_t>(k)].residual;
  const Eigen::VectorXd solved = matrix.partialPivLu().solve(rhs);
  for (Eigen::Index k = 0; k < m; ++k) step.multiplier[static_cast<std::size_t>(k)] = solved[k];
  return solved.allFinite();
}

template <class Gram>
bool solve_multipliers(const ChainSystem& system, const Gram& gram, ChainStep& step) {
  const auto m = static_cast<Eigen::Index>(system.rows.size());
  step.multiplier.resize(system.rows.size());
  if (m == 0) return true;
  if (system.follower.size() > 0) return solve_with_followers(system, gram, step);
  // Up to this many rows nothing is allocated.
  constexpr int kSmall = 16;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSmall, kSmall>;
  using SmallVec = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSmall, 1>;
  const auto solve = [&](auto schur, auto rhs) {
    schur = gram.bottomRightCorner(m, m);
    rhs = -gram.col(0).tail(m);
    for (Eigen::Index k = 0; k < m; ++k) rhs[k] += system.rows[static_cast<std::size_t>(k)].residual;
    const Eigen::LDLT<decltype(schur)> ldlt(schur);
    if (ldlt.info() != Eigen::Success) return false;
    const auto d = ldlt.vectorD();
    for (Eigen::Index k = 0; k < m; ++k) {
      if (d[k] == 0 || !std::isfinite(d[k])) return false;
      step.negative_pivots += d[k] > 0 ? 1 : 0;
    }
    step.negative_pivots -= static_cast<int>(m);
    rhs = ldlt.solve(rhs);
    for (Eigen::Index k = 0; k < m; ++k) step.multiplier[static_cast<std::size_t>(k)] = rhs[k];
    return rhs.allFinite();
  };
  return m <= kSmall ? solve(Small(m, m), SmallVec(m)) : solve(Eigen::MatrixXd(m, m), Eigen::VectorXd(m));
}

/// Eliminates the free coordinates of the base; leaves the solution operator in `inverse` (zero where fixed).
bool eliminate_base(const ChainSystem& system, const Mat6& p, Mat6& inverse, int& negative) {
  inverse.setZero();
  std::array<Eigen::Index, 6> free{};
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (!system.base_fixed[static_cast<std::size_t>(k)]) free[static_cast<std::size_t>(count++)] = k;
  }
  if (count == 0) return true;
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  Block block(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b)
      block(a, b) = p(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]);
  }
  const Eigen::LDLT<Block> ldlt(block);
  const auto d = ldlt.vectorD();
  for (Eigen::Index k = 0; k < count; ++k) {
    if (d[k] == 0 || !std::isfinite(d[k])) return false;
    negative += d[k] < 0 ? 1 : 0;
  }
  const Block solved = ldlt.solve(Block::Identity(count, count));
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b)
      inverse(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]) = solved(a, b);
  }
  return true;
}

template <int M>
class Sweep {
  using Block = typename Columns<M>::Block;
  using Pair = typename Columns<M>::Pair;
  using Gram = typename Columns<M>::Gram;

 public:
  Sweep(const ChainSystem& system, ChainWorkspace& work)
      : system_(system), work_(work), m_(static_cast<Eigen::Index>(system.rows.size()) + 1) {
    columns_.setZero(8, m_);
    gram_.setZero(m_, m_);
  }

  bool backward(ChainStep& step) {
    const int last = static_cast<int>(system_.links.size()) - 1;
    Cursor next{0, 0, system_.probe_count()};
    step.negative_pivots = 0;
    for (int i = last; i >= 0; --i) {
      const auto k = static_cast<std::size_t>(i);
      const ChainLink& link = system_.links[k];
      add_pose_parts(system_, i, next, value_, columns_);
      value_.p.diagonal().template head<3>().array() += link.stiffness;
      columns_.col(0).template head<3>() += link.force;
      value_.force += link.force;
      work_.force[k] = value_.force;
      work_.torque[k] = value_.torque;
      pass_joint(link, system_.geometric, value_, columns_);
      if (i == 0) add_first_u();
      if (!eliminate(i, step)) return false;
      if (i > 0) pass_span(system_.links[k - 1].span, system_.geometric, value_, columns_);
    }
    return finish_base(step);
  }

  void forward(ChainStep& step) const {
    Eigen::Matrix<double, M == 0 ? Eigen::Dynamic : M, 1> weights(m_);
    weights[0] = 1;
    for (Eigen::Index k = 1; k < m_; ++k) weights[k] = step.multiplier[static_cast<std::size_t>(k - 1)];
    step.base = -(base_inverse_ * (columns_.template topRows<6>() * weights));
    Vec6 pose = step.base;
    Vec2 previous = Vec2::Zero();
    const std::size_t count = system_.links.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ChainLink& link = system_.links[i];
      const Vec2 u = -(gain_columns(i) * weights + work_.gains[i].pose * pose + work_.gains[i].previous * previous);
      step.v[i] = pose.head<3>();
      step.u[i] = u;
      pose.tail<3>() += link.axes * u;
      if (i + 1 < count) pose.head<3>() += pose.tail<3>().cross(link.span);
      previous = u;
    }
  }

  bool multipliers(ChainStep& step) const { return solve_multipliers(system_, gram_, step); }

 private:
  Eigen::Map<Pair> gain_columns(std::size_t i) const {
    return Eigen::Map<Pair>(work_.columns.data() + i * 2 * static_cast<std::size_t>(m_), 2, m_);
  }

  void add_first_u() {
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      columns_.col(static_cast<Eigen::Index>(k) + 1).template tail<2>() += system_.rows[k].first_u;
      value_.gradient += system_.rows[k].multiplier * system_.rows[k].first_u;
    }
  }

  /// Takes in the energy of link i - 1 and eliminates u_i; what is left depends on u_{i-1}.
  bool eliminate(int i, ChainStep& step) {
    const auto k = static_cast<std::size_t>(i);
    const ChainLink* before = i > 0 ? &system_.links[k - 1] : nullptr;
    if (before) {
      value_.z += before->hess_bb;
      columns_.col(0).template tail<2>() += before->grad_b;
      value_.gradient += before->grad_b;
    }
    value_.z(0, 0) += system_.shift[0];
    value_.z(1, 1) += system_.shift[1];
    work_.gradient[k] = value_.gradient;
    Mat2 inverse;
    if (!invert(value_.z, inverse)) return false;
    step.negative_pivots += negative_count(value_.z);

    const Eigen::Matrix<double, 6, 2> yz = value_.y * inverse;
    const Pair zc = columns_.template bottomRows<2>();
    auto solved = gain_columns(k);
    solved.noalias() = inverse * zc;
    gram_.noalias() += zc.transpose() * solved;
    columns_.template topRows<6>().noalias() -= yz * zc;
    value_.p.noalias() -= yz * value_.y.transpose();
    ChainGain& gain = work_.gains[k];
    gain.pose = yz.transpose();
    if (before) {
      const Mat2& c = before->hess_ab;
      gain.previous.noalias() = inverse * c.transpose();
      value_.y = -(yz * c.transpose());
      value_.z = before->hess_aa - c * gain.previous;
      columns_.template bottomRows<2>().noalias() = -(c * solved);
      columns_.col(0).template tail<2>() += before->grad_a;
      value_.gradient = before->grad_a;
    } else {
      gain.previous.setZero();
    }
    return true;
  }

  bool finish_base(ChainStep& step) {
    work_.base_gradient << value_.force, value_.torque;
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      auto column = columns_.col(static_cast<Eigen::Index>(k) + 1);
      column.template head<3>() += system_.rows[k].base_v;
      column.template segment<3>(3) += system_.rows[k].base_theta;
      work_.base_gradient.head<3>() += system_.rows[k].multiplier * system_.rows[k].base_v;
      work_.base_gradient.tail<3>() += system_.rows[k].multiplier * system_.rows[k].base_theta;
    }
    if (!eliminate_base(system_, value_.p, base_inverse_, step.negative_pivots)) return false;
    const auto top = columns_.template topRows<6>();
    gram_ += top.transpose() * base_inverse_ * top;
    return true;
  }

  const ChainSystem& system_;
  ChainWorkspace& work_;
  Eigen::Index m_;
  Value value_;
  Block columns_;
  Gram gram_;
  Mat6 base_inverse_;
};

template <int M>
bool run_sweep(const ChainSystem& system, ChainWorkspace& work, ChainStep& step) {
  Sweep<M> sweep(system, work);
  if (!sweep.backward(step) || !sweep.multipliers(step)) return false;
  sweep.forward(step);
  return step.base.allFinite();
}

}  // namespace

bool chain_step(const ChainSystem& system, ChainWorkspace& work, ChainStep& step) {
  const std::size_t count = system.links.size();
  const std::size_t m = system.rows.size() + 1;
  assert(count >= 2);
  const auto probes = system.rows.begin() + static_cast<std::ptrdiff_t>(system.probe_count());
  const auto later = [](const ChainRow& a, const ChainRow& b) { return a.node > b.node; };
  assert(std::is_sorted(system.rows.begin(), probes, later) && std::is_sorted(probes, system.rows.end(), later));
  work.gains.resize(count);
  work.columns.resize(count * 2 * m);
  work.force.resize(count);
  work.torque.resize(count);
  work.gradient.resize(count);
  step.u.resize(count);
  step.v.resize(count);
  switch (m) {
    case 1:
      return run_sweep<1>(system, work, step);
    case 7:
      return run_sweep<7>(system, work, step);
    case 9:
      return run_sweep<9>(system, work, step);
    default:
      return run_sweep<0>(system, work, step);
  }
}

}  // namespace wunderlich::math
