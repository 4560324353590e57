#include <cmath>

#include "wunderlich/math/chain_sparse.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::math {

namespace {

/// Where a point's seven unknowns are, and how it moves with them.
struct Lever {
  int at[7];
  Eigen::Matrix<double, 3, 7> move;
};

/// Fills one chain's part of matrix and right-hand side, entry by entry in an order that the key decides.
class Assembly {
 public:
  Assembly(const ChainSystem& system, const ChainUnknowns& chain, SparseWorkspace& work)
      : system_(system), chain_(chain), work_(work) {
    double rigidity = 0, length = 0;
    for (const ChainLink& link : system.links) {
      rigidity += std::abs(link.hess_bb(0, 0));
      length += first_three(link.span).squaredNorm();
    }
    const auto count = static_cast<double>(system.links.size());
    length = std::sqrt(length / count);
    // Of the size of a joint's own stiffness; it changes nothing but the pivots.
    held_turn_ = rigidity / (count * length * length);
    held_move_ = held_turn_ / (length * length);
  }

  void run() {
    for (int i = 0; i < static_cast<int>(system_.links.size()); ++i) add_node(i);
    for (const PoseTerm& term : system_.pose_terms) add_pose_term(term);
    for (const SurfaceTerm& term : system_.surfaces) add_surface(term);
    for (const SurfacePoint& point : system_.points) add_point(point);
    for (const PointCoupling& coupling : system_.couplings) {
      add_coupling(coupling, lever(coupling.a), lever(coupling.b), coupling.a == coupling.b);
    }
    for (std::size_t k = 0; k < system_.rows.size(); ++k) add_row(system_.rows[k], static_cast<int>(k));
    for (int c = 0; c < 3; ++c) {
      add(chain_.places[0].v + c, chain_.places[0].v + c, system_.base_shift[0]);
      add(chain_.theta_base + c, chain_.theta_base + c, system_.base_shift[1]);
    }
  }

  Lever lever(int index) const {
    const SurfacePoint& point = system_.points[static_cast<std::size_t>(index)];
    const NodePlaces& p = places(point.node);
    Lever lever{{p.v, p.v + 1, p.v + 2, p.theta, p.theta + 1, p.theta + 2, p.u + 1}, {}};
    lever.move << Mat3::Identity(), -skew(point.arm), point.slant;
    return lever;
  }

  /// What two points do to each other; the second may be another chain's.
  void add_coupling(const PointCoupling& coupling, const Lever& a, const Lever& b, bool same) {
    Mat3 between = coupling.hessian;
    if (system_.geometric) between += coupling.geometric;
    const Eigen::Matrix<double, 7, 7> block = a.move.transpose() * between * b.move;
    for (int c = 0; c < 7; ++c) {
      for (int r = same ? c : 0; r < 7; ++r) {
        // Two points of one node share unknowns: there both halves of the symmetric whole meet.
        const double twice = !same && a.at[r] == b.at[c] ? 2 : 1;
        add(a.at[r], b.at[c], twice * block(r, c));
      }
    }
  }

 private:
  void add(int row, int column, double value) {
    const bool fixed = work_.fixed[static_cast<std::size_t>(row)] || work_.fixed[static_cast<std::size_t>(column)];
    work_.matrix.add(row, column, fixed ? 0 : value);
  }

  /// A block; on the diagonal its lower triangle.
  template <class Block>
  void add_block(int row, int column, const Block& block) {
    for (int c = 0; c < block.cols(); ++c) {
      for (int r = row == column ? c : 0; r < block.rows(); ++r) add(row + r, column + c, block(r, c));
    }
  }

  template <class Part>
  void load(int row, const Part& gradient) {
    if (system_.only_load) return;
    for (int r = 0; r < gradient.size(); ++r) work_.right[row + r] -= gradient[r];
  }

  const NodePlaces& places(int node) const { return chain_.places[static_cast<std::size_t>(node)]; }

  /// A constraint of three rows: sum of blocks times unknowns = 0. Its square times `weight` is added as well: nothing
  /// where it holds, but the unknowns have pivots before their multipliers come.
  template <std::size_t N>
  void add_constraint(int multiplier, double weight, const std::array<int, N>& at,
                      const std::array<Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>, N>& part) {
    for (std::size_t a = 0; a < N; ++a) {
      add_block(multiplier, at[a], part[a]);
      for (std::size_t b = a; b < N; ++b) add_block(at[b], at[a], weight * part[b].transpose() * part[a]);
    }
  }

  void add_joint(int i) {
    const auto k = static_cast<std::size_t>(i);
    const ChainLink& link = system_.links[k];
    const NodePlaces& at = places(i);
    const NodeWrench& wrench = chain_.wrench[k];
    const Vec3 b0 = first_three(link.axis[0]), b1 = first_three(link.axis[1]);
    const int before = i > 0 ? places(i - 1).theta : chain_.theta_base;
    Mat2 own = Mat2::Zero();
    Eigen::Matrix<double, 3, 2> turned = Eigen::Matrix<double, 3, 2>::Zero();
    if (i > 0) own += system_.links[k - 1].hess_bb;
    if (k + 1 < system_.links.size()) own += link.hess_aa;
    if (system_.geometric) {
      own(0, 1) += wrench.torque.dot(first_three(link.axis_01));
      own(1, 1) += wrench.torque.dot(first_three(link.axis_11));
      turned << 0.5 * b0.cross(wrench.torque), 0.5 * b1.cross(wrench.torque);
    }
    own(0, 1) -= link.chart * (wrench.gradient[1] - (system_.geometric ? 0 : wrench.pull));
    own(1, 0) = own(0, 1);
    own.diagonal() += Vec2(system_.shift[0], system_.shift[1]);
    add_block(at.u, at.u, own);
    add_block(before, at.u, turned);
    if (i > 0) add_block(at.u, places(i - 1).u, system_.links[k - 1].hess_ab.transpose().eval());
    Eigen::Matrix<double, 3, 2> axes;
    axes << -b0, -b1;
    add_constraint<3>(at.turn, held_turn_, {at.theta, before, at.u}, {Mat3::Identity(), -Mat3::Identity(), axes});
    Vec2 gradient = Vec2::Zero();
    if (i > 0) gradient += system_.links[k - 1].grad_b;
    if (k + 1 < system_.links.size()) gradient += link.grad_a;
    load(at.u, gradient);
    if (system_.only_load) work_.right.segment<2>(at.u) = -(*system_.only_load)[k];
  }

  void add_node(int i) {
    const auto k = static_cast<std::size_t>(i);
    const ChainLink& link = system_.links[k];
    const NodePlaces& at = places(i);
    add_joint(i);
    add_block(at.v, at.v, Mat3(link.stiffness * Mat3::Identity()));
    load(at.v, first_three(link.force));
    Mat3 turn = Mat3::Zero();
    if (k < system_.turns.size()) {
      const TurnTerm& term = system_.turns[k];
      for (int r = 0; r < 3; ++r) {
        turn.row(r) = first_three(term.hessian[r]).transpose();
        if (system_.geometric) turn.row(r) += first_three(term.geometric[r]).transpose();
      }
      load(at.theta, Vec3(term.hessian[0][3], term.hessian[1][3], term.hessian[2][3]));
    }
    if (k + 1 < system_.links.size()) {
      const Vec3 span = first_three(link.span), force = chain_.wrench[k + 1].force;
      if (system_.geometric) {
        turn += 0.5 * (span * force.transpose() + force * span.transpose()) - span.dot(force) * Mat3::Identity();
      }
      const NodePlaces& next = places(i + 1);
      add_constraint<3>(next.move, held_move_, {next.v, at.v, at.theta},
                        {Mat3::Identity(), -Mat3::Identity(), skew(span)});
    }
    add_block(at.theta, at.theta, turn);
  }

  void add_pose_term(const PoseTerm& term) {
    const int v = places(std::max(term.node, 0)).v;
    const int theta = term.node < 0 ? chain_.theta_base : places(term.node).theta;
    add_block(v, v, term.hessian.topLeftCorner<3, 3>());
    add_block(theta, v, term.hessian.bottomLeftCorner<3, 3>());
    Mat3 turn = term.hessian.bottomRightCorner<3, 3>();
    if (system_.geometric) turn += term.geometric;
    add_block(theta, theta, turn);
    load(v, term.gradient.head<3>());
    load(theta, term.gradient.tail<3>());
  }

  void add_surface(const SurfaceTerm& term) {
    Mat8 hessian = term.hessian;
    if (system_.geometric) hessian += term.geometric;
    const NodePlaces &near = places(term.node), &far = places(term.node + 1);
    const int at[8] = {far.v, far.v + 1, far.v + 2, near.theta, near.theta + 1, near.theta + 2, near.u + 1, far.u + 1};
    for (int c = 0; c < 8; ++c) {
      for (int r = c; r < 8; ++r) add(at[r], at[c], hessian(r, c));
      load(at[c], Eigen::Matrix<double, 1, 1>(term.gradient[c]));
    }
  }

  /// The gradient, and what the force on a point adds because it moves on a curve.
  void add_point(const SurfacePoint& point) {
    const Lever lever = this->lever(static_cast<int>(&point - system_.points.data()));
    const Vec3& force = point.gradient;
    const Eigen::Matrix<double, 7, 1> gradient = lever.move.transpose() * force;
    for (int c = 0; c < 7; ++c) load(lever.at[c], Eigen::Matrix<double, 1, 1>(gradient[c]));
    const double share = system_.geometric ? 1 : 0;
    const Mat3 turn = share * (0.5 * (force * point.arm.transpose() + point.arm * force.transpose()) -
                               force.dot(point.arm) * Mat3::Identity());
    add_block(lever.at[3], lever.at[3], turn);
    const Vec3 slant = share * point.slant.cross(force);
    for (int c = 0; c < 3; ++c) add(lever.at[3 + c], lever.at[6], slant[c]);
  }

  void add_row(const ChainRow& row, int k) {
    const int at = chain_.first_row + k;
    const NodePlaces& node = places(std::max(row.node, 0));
    const auto add_part = [&](int column, const auto& part) {
      for (int c = 0; c < part.size(); ++c) add(at, column + c, part[c]);
    };
    add_part(node.v, row.v);
    add_part(row.node < 0 ? chain_.theta_base : node.theta, row.theta);
    add_part(node.u, row.u);
    add_part(places(0).v, row.base_v);
    add_part(chain_.theta_base, row.base_theta);
    add_part(places(0).u, row.first_u);
    work_.right[at] = -row.residual;
  }

  const ChainSystem& system_;
  const ChainUnknowns& chain_;
  SparseWorkspace& work_;
  double held_turn_ = 0, held_move_ = 0;
};

}  // namespace

void assemble(std::span<const ChainPart> parts, const std::vector<ChainCoupling>& between, SparseWorkspace& work) {
  work.right.setZero(work.size);
  std::vector<Assembly> chains;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    chains.emplace_back(*parts[c].system, work.chains[c], work).run();
  }
  for (const auto& [chain, points] : between) {
    Assembly &a = chains[static_cast<std::size_t>(chain[0])], &b = chains[static_cast<std::size_t>(chain[1])];
    a.add_coupling(points, a.lever(points.a), b.lever(points.b), false);
  }
  for (int k = 0; k < work.size; ++k) {
    const bool fixed = work.fixed[static_cast<std::size_t>(k)] != 0;
    work.matrix.add(k, k, fixed ? 1 : 0);
    if (fixed) work.right[k] = 0;
  }
}

}  // namespace wunderlich::math
