#include "wunderlich/math/chain_sweep.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "wunderlich/math/chain_sparse.hpp"
#include "wunderlich/math/chain_value.hpp"

namespace wunderlich::math {

using namespace chain;

namespace {

/// Schur complement of the rows and the gradient's column of it, as the sweep leaves them: a column-major square of
/// `size` with its lower triangle filled, and a vector.
struct Gram {
  const double* schur;
  const double* load;
  Eigen::Index size;
};

template <class Matrix, class Vector>
void read_gram(const ChainSystem& system, const Gram& gram, Matrix& schur, Vector& rhs) {
  const auto m = static_cast<Eigen::Index>(system.rows.size());
  for (Eigen::Index c = 0; c < m; ++c) {
    for (Eigen::Index r = c; r < m; ++r) schur(r, c) = schur(c, r) = gram.schur[c * gram.size + r];
    rhs[c] = system.rows[static_cast<std::size_t>(c)].residual - gram.load[c];
  }
}

/// Loads without a potential: their rows are probes y = row . x with multiplier follower * y, solved together with
/// the constraints. The probes come first.
bool solve_with_followers(const ChainSystem& system, const Gram& gram, ChainStep& step) {
  const auto m = static_cast<Eigen::Index>(system.rows.size());
  const Eigen::Index probes = system.follower.rows();
  Eigen::MatrixXd schur(m, m);
  Eigen::VectorXd rhs(m);
  read_gram(system, gram, schur, rhs);
  // probes: (1 + K T) lambda = K rhs;   constraints: T lambda = residual + rhs
  Eigen::MatrixXd matrix = schur;
  matrix.topRows(probes) = system.follower * schur.topRows(probes);
  matrix.topLeftCorner(probes, probes).diagonal().array() += 1;
  rhs.head(probes) = (system.follower * rhs.head(probes)).eval();
  const Eigen::VectorXd solved = matrix.partialPivLu().solve(rhs);
  for (Eigen::Index k = 0; k < m; ++k) step.multiplier[static_cast<std::size_t>(k)] = solved[k];
  return solved.allFinite();
}

bool solve_multipliers(const ChainSystem& system, const Gram& gram, ChainStep& step) {
  const auto m = static_cast<Eigen::Index>(system.rows.size());
  step.multiplier.resize(system.rows.size());
  if (m == 0) return true;
  if (system.follower.size() > 0) return solve_with_followers(system, gram, step);
  const auto solve = [&](auto schur, auto rhs) {
    read_gram(system, gram, schur, rhs);
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
  // Up to this many rows nothing is allocated.
  constexpr int kSmall = 16;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSmall, kSmall>;
  using SmallVec = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSmall, 1>;
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
  // Where a coordinate is fixed the unit matrix stands in: blocks of a known size are several times as fast.
  Mat6 block = Mat6::Identity();
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b)
      block(a, b) = p(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]);
  }
  const Eigen::LDLT<Mat6> ldlt(block);
  const auto d = ldlt.vectorD();
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (d[k] == 0 || !std::isfinite(d[k])) return false;
    negative += d[k] < 0 ? 1 : 0;
  }
  for (Eigen::Index b = 0; b < count; ++b) {
    const Vec6 solved = ldlt.solve(Vec6::Unit(b));
    for (Eigen::Index a = 0; a < count; ++a)
      inverse(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]) = solved[a];
  }
  return true;
}

/// Constraint columns' inner products in the inverse Hessian; row 4Q is the gradient's.
template <int Q>
struct GramRows {
  Four value[4 * Q + 1][Q > 0 ? Q : 1] = {};
  explicit GramRows(int) {}
  Four* row(int a) { return value[a]; }
};

template <>
struct GramRows<-1> {
  int quads;
  std::vector<Four> value;
  explicit GramRows(int q) : quads(q), value(static_cast<std::size_t>((4 * q + 1) * q), all(0)) {}
  Four* row(int a) { return value.data() + a * quads; }
};

template <int Q>
class Sweep {
 public:
  Sweep(const ChainSystem& system, ChainWorkspace& work, int quads)
      : system_(system), work_(work), quads_(quads), columns_(quads), gram_(quads) {}

  bool backward(ChainStep& step) {
    const int last = static_cast<int>(system_.links.size()) - 1;
    const double share = gradient_share(system_);
    Cursor next{0, 0, system_.probe_count()};
    Value value;  // here and not a member: the compiler then keeps it in registers
    step.negative_pivots = 0;
    for (int i = last; i >= 0; --i) {
      const auto k = static_cast<std::size_t>(i);
      const ChainLink& link = system_.links[k];
      add_pose_parts(system_, i, next, value, columns_);
      add_node(link, share, value);
      if (k < system_.turns.size()) add_turn(system_.turns[k], share, system_.geometric, value);
      pass_joint(link, system_.geometric, value, columns_);
      if (i == 0) add_first_u(value);
      const SurfaceTerm* surface = nullptr;
      if (next.surface < system_.surfaces.size() && system_.surfaces[next.surface].node == i - 1)
        surface = &system_.surfaces[next.surface++];
      if (!eliminate(k, surface, share, value, step)) return false;
      if (i > 0) pass_span(system_.links[k - 1].span, system_.geometric, value, columns_);
    }
    add_pose_parts(system_, -1, next, value, columns_);
    return finish_base(value, step);
  }

  bool multipliers(ChainStep& step) {
    const Gram gram{reinterpret_cast<const double*>(gram_.row(0)),
                    reinterpret_cast<const double*>(gram_.row(4 * columns_.quads())), 4 * columns_.quads()};
    return solve_multipliers(system_, gram, step);
  }

  void forward(ChainStep& step) const {
    step.base = -(base_inverse_ * base_load(step));
    Four v = four(step.base.head<3>()), theta = four(step.base.tail<3>(), 1);
    Four previous = all(0);  // -(u0, u0, u1, u1) of the joint before
    const std::size_t count = system_.links.size();
    Columns<Q> weight(quads_);  // its first row: the multipliers
    for (std::size_t k = 0; k < system_.rows.size(); ++k)
      add_lane(weight.row(0), static_cast<int>(k), step.multiplier[k]);
    for (std::size_t i = 0; i < count; ++i) {
      const ChainLink& link = system_.links[i];
      const ChainGain& gain = work_.gains[i];
      Four sum0 = gain.v[0] * v + gain.theta[0] * theta, sum1 = gain.v[1] * v + gain.theta[1] * theta;
      const Four* solved = solved_columns(i);
      for (int e = 0; e < columns_.quads(); ++e) {
        sum0 += solved[e] * weight.row(0)[e];
        sum1 += solved[columns_.quads() + e] * weight.row(0)[e];
      }
      const Four halves = pair_sums(sum0, sum1) - gain.previous * previous;
      const Four minus_u = halves + swap_halves(halves);  // (u0, u1, u0, u1), negative
      step.v[i] = first_three(v);
      step.u[i] = {-minus_u[0], -minus_u[1]};
      theta -= double_even(minus_u) * link.axis[0] + double_odd(minus_u) * link.axis[1];
      if (i + 1 < count) v += cross(theta, link.span);
      previous = double_ends(minus_u);
    }
  }

 private:
  Four* solved_columns(std::size_t i) const {
    return work_.columns.data() + i * 2 * static_cast<std::size_t>(columns_.quads());
  }

  Vec6 base_load(const ChainStep& step) const {
    Vec6 load = base_gradient_;
    for (int i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < system_.rows.size(); ++k)
        load[i] += lane(columns_.row(i), static_cast<int>(k)) * step.multiplier[k];
    }
    return load;
  }

  void add_first_u(Value& value) {
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      const ChainRow& row = system_.rows[k];
      add_lane(columns_.row(6), static_cast<int>(k), row.first_u[0]);
      add_lane(columns_.row(7), static_cast<int>(k), row.first_u[1]);
      value.gradient0 += row.multiplier * row.first_u[0];
      value.gradient1 += row.multiplier * row.first_u[1];
    }
  }

  /// Takes in the energy of link i - 1, and what its surface feels, and eliminates u_i; what is left depends on
  /// u_{i-1}.
  bool eliminate(std::size_t i, const SurfaceTerm* surface, double share, Value& value, ChainStep& step) {
    const ChainLink* before = i > 0 ? &system_.links[i - 1] : nullptr;
    Mat8 felt;
    if (surface) {
      felt = surface->hessian;
      if (system_.geometric) felt += surface->geometric;
      add_surface(*surface, felt, share, value);
    }
    if (system_.only_load) {
      value.ut[0] += last_lane((*system_.only_load)[i][0]);
      value.ut[1] += last_lane((*system_.only_load)[i][1]);
    }
    if (before) {
      value.z00 += before->hess_bb(0, 0);
      value.z01 += before->hess_bb(0, 1);
      value.z11 += before->hess_bb(1, 1);
      value.ut[0] += last_lane(share * before->grad_b[0]);
      value.ut[1] += last_lane(share * before->grad_b[1]);
      value.gradient0 += before->grad_b[0];
      value.gradient1 += before->grad_b[1];
    }
    // In another chart the gradient bends the Hessian otherwise; forces that are left out bend nothing.
    value.z01 -= system_.links[i].chart * (value.gradient1 - (system_.geometric ? 0 : value.pull1));
    value.z00 += system_.shift[0];
    value.z11 += system_.shift[1];
    work_.gradient[i] = {value.gradient0, value.gradient1};
    const double det = value.z00 * value.z11 - value.z01 * value.z01;
    if (det == 0 || !std::isfinite(det)) return false;
    step.negative_pivots += det < 0 ? 1 : value.z00 + value.z11 < 0 ? 2 : 0;
    const double f = 1 / det, i00 = f * value.z11, i01 = -f * value.z01, i11 = f * value.z00;

    ChainGain& gain = work_.gains[i];
    reduce_pose(i00, i01, i11, value, gain);
    reduce_columns(i00, i01, i11, value, solved_columns(i));
    if (!before) {
      gain.previous = all(0);
      return true;
    }
    const double c00 = before->hess_ab(0, 0), c01 = before->hess_ab(0, 1);
    const double c10 = before->hess_ab(1, 0), c11 = before->hess_ab(1, 1) + (surface ? felt(6, 7) : 0);
    const double p00 = i00 * c00 + i01 * c01, p01 = i00 * c10 + i01 * c11;
    const double p10 = i01 * c00 + i11 * c01, p11 = i01 * c10 + i11 * c11;
    gain.previous = Four{p00, p10, p01, p11};
    value.z00 = before->hess_aa(0, 0) - c00 * p00 - c01 * p10;
    value.z01 = before->hess_aa(0, 1) - c00 * p01 - c01 * p11;
    value.z11 = before->hess_aa(1, 1) - c10 * p01 - c11 * p11;
    value.gradient0 = before->grad_a[0];
    value.gradient1 = before->grad_a[1];
    value.pull1 = 0;
    couple(c00, c01, gain, 0, share * before->grad_a[0], value, solved_columns(i));
    couple(c10, c11, gain, 1, share * before->grad_a[1], value, solved_columns(i));
    if (surface) add_surface_before(*surface, felt, share, value);
    return true;
  }

  /// Row c of u_{i-1}: minus the coupling times what was eliminated, and the link's own gradient.
  void couple(double c0, double c1, const ChainGain& gain, int c, double gradient, Value& value, const Four* solved) {
    const Four n0 = all(-c0), n1 = all(-c1);
    value.uv[c] = n0 * gain.v[0] + n1 * gain.v[1];
    value.ut[c] = n0 * gain.theta[0] + n1 * gain.theta[1] + last_lane(gradient);
    Four* row = columns_.row(6 + c);
    const int q = columns_.quads();
    for (int e = 0; e < q; ++e) row[e] = n0 * solved[e] + n1 * solved[q + e];
  }

  /// P -= Y Z^-1 Y^T with the gradient as a further column; leaves Z^-1 Y^T in `gain`.
  static void reduce_pose(double i00, double i01, double i11, Value& value, ChainGain& gain) {
    const Four a = all(i00), b = all(i01), c = all(i11);
    const Four v0 = a * value.uv[0] + b * value.uv[1], v1 = b * value.uv[0] + c * value.uv[1];
    const Four t0 = a * value.ut[0] + b * value.ut[1], t1 = b * value.ut[0] + c * value.ut[1];
    for (int r = 0; r < 3; ++r) {
      const Four y0 = all(value.uv[0][r]), y1 = all(value.uv[1][r]);
      value.vv[r] -= y0 * v0 + y1 * v1;
      value.vt[r] -= y0 * t0 + y1 * t1;
      value.tt[r] -= all(value.ut[0][r]) * t0 + all(value.ut[1][r]) * t1;
    }
    gain.v[0] = v0;
    gain.v[1] = v1;
    gain.theta[0] = t0;
    gain.theta[1] = t1;
  }

  /// The same for the constraint columns, with their Gram matrix; leaves Z^-1 times the columns in `solved`.
  void reduce_columns(double i00, double i01, double i11, const Value& value, Four* __restrict solved) {
    const int q = columns_.quads();
    if (q == 0) return;
    const Four *z0 = columns_.row(6), *z1 = columns_.row(7);
    for (int e = 0; e < q; ++e) {
      solved[e] = all(i00) * z0[e] + all(i01) * z1[e];
      solved[q + e] = all(i01) * z0[e] + all(i11) * z1[e];
    }
    const auto add_products = [&](double x0, double x1, Four* out, int from, double sign) {
      for (int e = from; e < q; ++e) out[e] += all(sign * x0) * solved[e] + all(sign * x1) * solved[q + e];
    };
    for (int r = 0; r < 3; ++r) {
      add_products(value.uv[0][r], value.uv[1][r], columns_.row(r), 0, -1);
      add_products(value.ut[0][r], value.ut[1][r], columns_.row(3 + r), 0, -1);
    }
    for (int a = 0; a < 4 * q; ++a) add_products(lane(z0, a), lane(z1, a), gram_.row(a), a / 4, 1);
    add_products(value.ut[0][3], value.ut[1][3], gram_.row(4 * q), 0, 1);
  }

  bool finish_base(const Value& value, ChainStep& step) {
    work_.base_gradient << first_three(value.force), first_three(value.torque);
    for (std::size_t k = 0; k < system_.rows.size(); ++k) {
      const ChainRow& row = system_.rows[k];
      for (int i = 0; i < 3; ++i) {
        add_lane(columns_.row(i), static_cast<int>(k), row.base_v[i]);
        add_lane(columns_.row(3 + i), static_cast<int>(k), row.base_theta[i]);
      }
      work_.base_gradient.head<3>() += row.multiplier * row.base_v;
      work_.base_gradient.tail<3>() += row.multiplier * row.base_theta;
    }
    Mat6 p;
    for (int i = 0; i < 3; ++i) {
      p.block<1, 3>(i, 0) = first_three(value.vv[i]).transpose();
      p.block<1, 3>(i, 3) = first_three(value.vt[i]).transpose();
      p.block<3, 1>(3, i) = first_three(value.vt[i]);
      p.block<1, 3>(3 + i, 3) = first_three(value.tt[i]).transpose();
      base_gradient_[i] = value.vt[i][3];
      base_gradient_[3 + i] = value.tt[i][3];
    }
    p.diagonal().head<3>().array() += system_.base_shift[0];
    p.diagonal().tail<3>().array() += system_.base_shift[1];
    if (!eliminate_base(system_, p, base_inverse_, step.negative_pivots)) return false;
    add_base_products();
    return true;
  }

  Vec6 base_column(int k) const {
    Vec6 column;
    for (int i = 0; i < 6; ++i) column[i] = lane(columns_.row(i), k);
    return column;
  }

  void add_base_products() {
    const int rows = static_cast<int>(system_.rows.size());
    for (int a = 0; a < rows; ++a) {
      const Vec6 solved = base_inverse_ * base_column(a);
      for (int b = a; b < rows; ++b) add_lane(gram_.row(a), b, solved.dot(base_column(b)));
      add_lane(gram_.row(4 * columns_.quads()), a, solved.dot(base_gradient_));
    }
  }

  const ChainSystem& system_;
  ChainWorkspace& work_;
  int quads_;
  Columns<Q> columns_;
  GramRows<Q> gram_;
  Vec6 base_gradient_;
  Mat6 base_inverse_;
};

template <int Q>
bool run_sweep(const ChainSystem& system, ChainWorkspace& work, ChainStep& step, int quads) {
  Sweep<Q> sweep(system, work, quads);
  if (!sweep.backward(step) || !sweep.multipliers(step)) return false;
  sweep.forward(step);
  return step.base.allFinite();
}

}  // namespace

bool chain_step(const ChainSystem& system, ChainWorkspace& work, ChainStep& step) {
  if (!system.couplings.empty()) return sparse_chain_step(system, work, step);
  const std::size_t count = system.links.size();
  const auto probes = system.rows.begin() + static_cast<std::ptrdiff_t>(system.probe_count());
  const auto later = [](const ChainRow& a, const ChainRow& b) { return a.node > b.node; };
  assert(std::is_sorted(system.rows.begin(), probes, later) && std::is_sorted(probes, system.rows.end(), later));
  const int quads = static_cast<int>((system.rows.size() + 3) / 4);
  work.gains.resize(count);
  work.columns.resize(count * 2 * static_cast<std::size_t>(quads));
  work.gradient.resize(count);
  step.u.resize(count);
  step.v.resize(count);
  switch (quads) {
    case 0:
      return run_sweep<0>(system, work, step, quads);
    case 1:
      return run_sweep<1>(system, work, step, quads);
    case 2:
      return run_sweep<2>(system, work, step, quads);
    default:
      return run_sweep<-1>(system, work, step, quads);
  }
}

}  // namespace wunderlich::math
