#include "wunderlich/math/chain_sweep.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "wunderlich/math/chain_value.hpp"

namespace wunderlich::math {

using namespace chain;

namespace {

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
  using Gram = typename GramOf<M>::Type;

 public:
  Sweep(const ChainSystem& system, ChainWorkspace& work)
      : system_(system), work_(work), m_(static_cast<int>(system.rows.size()) + 1), columns_(m_) {
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
      add_node(link, gradient_share(system_), value_, columns_.row(0), columns_.row(1), columns_.row(2));
      work_.force[k] = value_.force;
      work_.torque[k] = value_.torque;
      pass_joint(link, system_.geometric, value_, columns_);
      if (i == 0) add_first_u();
      if (!eliminate(i, step)) return false;
      if (i > 0) pass_span(system_.links[k - 1].span, system_.geometric, value_, columns_);
    }
    add_pose_parts(system_, -1, next, value_, columns_);
    return finish_base(step);
  }

  void forward(ChainStep& step) const {
    step.base = -(base_inverse_ * base_load(step));
    Vec6 pose = step.base;
    Vec2 previous = Vec2::Zero();
    const std::size_t count = system_.links.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ChainLink& link = system_.links[i];
      const double *g0 = gain_columns(i), *g1 = g0 + m_;
      Vec2 u(g0[0], g1[0]);
      for (int k = 1; k < m_; ++k) {
        const double weight = step.multiplier[static_cast<std::size_t>(k - 1)];
        u += weight * Vec2(g0[k], g1[k]);
      }
      u = -(u + work_.gains[i].pose * pose + work_.gains[i].previous * previous);
      step.v[i] = pose.head<3>();
      step.u[i] = u;
      pose.tail<3>() += link.axes * u;
      if (i + 1 < count) pose.head<3>() += pose.tail<3>().cross(link.span);
      previous = u;
    }
  }

  bool multipliers(ChainStep& step) const { return solve_multipliers(system_, gram_, step); }

 private:
  double* gain_columns(std::size_t i) const { return work_.columns.data() + i * 2 * static_cast<std::size_t>(m_); }

  Vec6 base_load(const ChainStep& step) const {
    Vec6 load;
    for (int i = 0; i < 6; ++i) {
      load[i] = columns_.row(i)[0];
      for (int k = 1; k < m_; ++k) load[i] += columns_.row(i)[k] * step.multiplier[static_cast<std::size_t>(k - 1)];
    }
    return load;
  }

  void add_first_u() {
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      const ChainRow& row = system_.rows[k];
      columns_.row(6)[k + 1] += row.first_u[0];
      columns_.row(7)[k + 1] += row.first_u[1];
      value_.gradient += row.multiplier * row.first_u;
    }
  }

  /// Takes in the energy of link i - 1 and eliminates u_i; what is left depends on u_{i-1}.
  bool eliminate(int i, ChainStep& step) {
    const auto index = static_cast<std::size_t>(i);
    const ChainLink* before = i > 0 ? &system_.links[index - 1] : nullptr;
    double *z0 = columns_.row(6), *z1 = columns_.row(7);
    const double share = gradient_share(system_);
    if (system_.only_load) {
      z0[0] += (*system_.only_load)[index][0];
      z1[0] += (*system_.only_load)[index][1];
    }
    if (before) {
      value_.z += before->hess_bb;
      z0[0] += share * before->grad_b[0];
      z1[0] += share * before->grad_b[1];
      value_.gradient += before->grad_b;
    }
    value_.z(0, 0) += system_.shift[0];
    value_.z(1, 1) += system_.shift[1];
    work_.gradient[index] = value_.gradient;
    Mat2 inverse;
    if (!invert(value_.z, inverse)) return false;
    step.negative_pivots += negative_count(value_.z);

    double* solved = gain_columns(index);
    reduce_columns(inverse, z0, z1, solved);
    Eigen::Matrix<double, 2, 6>& gain = work_.gains[index].pose;
    reduce_pose(inverse, z0, z1, gain);
    if (!before) {
      work_.gains[index].previous.setZero();
      return true;
    }
    const Mat2 c = before->hess_ab;
    const Mat2 previous = inverse * c.transpose();
    work_.gains[index].previous = previous;
    value_.z = before->hess_aa - c * previous;
    for (int r = 0; r < 6; ++r) {
      const double y0 = gain(0, r), y1 = gain(1, r);
      value_.y[r][0] = -(y0 * c(0, 0) + y1 * c(0, 1));
      value_.y[r][1] = -(y0 * c(1, 0) + y1 * c(1, 1));
    }
    for (int k = 0; k < columns_.count(); ++k) {
      const double s0 = solved[k], s1 = solved[m_ + k];
      z0[k] = -(c(0, 0) * s0 + c(0, 1) * s1);
      z1[k] = -(c(1, 0) * s0 + c(1, 1) * s1);
    }
    z0[0] += share * before->grad_a[0];
    z1[0] += share * before->grad_a[1];
    value_.gradient = before->grad_a;
    return true;
  }

  /// Z^-1 times the columns, and their Gram matrix.
  void reduce_columns(Mat2 inverse, const double* __restrict z0, const double* __restrict z1,
                      double* __restrict solved) {
    const int m = columns_.count();
    for (int k = 0; k < m; ++k) {
      solved[k] = inverse(0, 0) * z0[k] + inverse(0, 1) * z1[k];
      solved[m + k] = inverse(1, 0) * z0[k] + inverse(1, 1) * z1[k];
    }
    double* __restrict gram = gram_.data();
    for (int a = 0; a < m; ++a) {
      for (int b = 0; b < m; ++b) gram[a * m + b] += z0[a] * solved[b] + z1[a] * solved[m + b];
    }
  }

  /// P -= Y Z^-1 Y^T and the pose rows of the columns -= Y Z^-1 z; leaves (Y Z^-1)^T in `gain`.
  void reduce_pose(Mat2 inverse, const double* __restrict z0, const double* __restrict z1,
                   Eigen::Matrix<double, 2, 6>& gain) {
    double y0[6], y1[6];
    for (int r = 0; r < 6; ++r) y0[r] = value_.y[r][0], y1[r] = value_.y[r][1];
    for (int r = 0; r < 6; ++r) {
      const double g0 = y0[r] * inverse(0, 0) + y1[r] * inverse(1, 0);
      const double g1 = y0[r] * inverse(0, 1) + y1[r] * inverse(1, 1);
      gain(0, r) = g0;
      gain(1, r) = g1;
      for (int c = 0; c < 6; ++c) value_.p[r][c] -= g0 * y0[c] + g1 * y1[c];
      double* __restrict row = columns_.row(r);
      for (int k = 0; k < columns_.count(); ++k) row[k] -= g0 * z0[k] + g1 * z1[k];
    }
  }

  bool finish_base(ChainStep& step) {
    work_.base_gradient << value_.force, value_.torque;
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      const ChainRow& row = system_.rows[k];
      for (int i = 0; i < 3; ++i) {
        columns_.row(i)[k + 1] += row.base_v[i];
        columns_.row(3 + i)[k + 1] += row.base_theta[i];
      }
      work_.base_gradient.head<3>() += row.multiplier * row.base_v;
      work_.base_gradient.tail<3>() += row.multiplier * row.base_theta;
    }
    Mat6 p = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(&value_.p[0][0]);
    p.diagonal().head<3>().array() += system_.base_shift[0];
    p.diagonal().tail<3>().array() += system_.base_shift[1];
    if (!eliminate_base(system_, p, base_inverse_, step.negative_pivots)) return false;
    const Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>> top(columns_.row(0), 6, m_);
    gram_ += top.transpose() * base_inverse_ * top;
    return true;
  }

  const ChainSystem& system_;
  ChainWorkspace& work_;
  int m_;
  Value value_;
  Columns<M> columns_;
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
