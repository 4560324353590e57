#include "wunderlich/solver/chain_rows.hpp"

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using constraint::Orientation;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::ChainRow;

namespace {

/// Turn of the frame `q` about its tangent against `reference` transported along the shortest rotation of the
/// tangent, and the row that is its gradient.                                            @eq Shen2015:18
struct TangentTurn {
  double angle = 0;
  Vec3 gradient = Vec3::Zero();
};

TangentTurn tangent_turn(const Quat& q, const Quat& reference) {
  const Vec3 t0 = reference * Vec3::UnitZ(), t1 = q * Vec3::UnitZ();
  const Quat carried = math::shortest_rotation(t0, t1) * reference;
  const Vec3 turn = math::log_map(q * carried.conjugate());
  return {turn.dot(t1), (t0 + t1) / (1 + t0.dot(t1))};
}

/// Calls `emit(v, theta, residual)` for each row of a hold.
template <class Emit>
void for_each_row(const Hold& hold, const Chain& chain, const Kinematics& k, const Emit& emit) {
  const auto i = static_cast<std::size_t>(hold.node);
  const Vec3 gap = k.r[i] - hold.target.position;
  for (int c = 0; c < 3; ++c) {
    if (hold.position[static_cast<std::size_t>(c)]) emit(Vec3::Unit(c), Vec3::Zero(), gap[c]);
  }
  if (hold.orientation == Orientation::full) {
    // The step's total rotation is exactly minus this vector, so the row is linear.
    const Vec3 turn = math::log_map(k.q[i] * hold.target.frame.conjugate());
    for (int c = 0; c < 3; ++c) emit(Vec3::Zero(), Vec3::Unit(c), turn[c]);
  } else if (hold.orientation == Orientation::about_tangent) {
    const TangentTurn turn = tangent_turn(hold.on_base ? chain.base.frame : k.q[i], hold.target.frame);
    emit(Vec3::Zero(), turn.gradient, turn.angle);
  }
}

/// The last frame is the first one seen across the seam, and so are kappa and eta.
struct Closure {
  Vec3 gap;
  Vec3 turn;
  Vec2 u;
};

Closure closure(const Ribbon& ribbon, const Chain& chain, const Kinematics& k) {
  const Quat ghost = geometry::across_seam(ribbon, k.q.front());
  return {k.r.back() - k.r.front(), math::log_map(k.q.back() * ghost.conjugate()),
          Vec2(chain.kappa.back() - ribbon.seam_sign() * chain.kappa.front(),
               chain.eta.back() - ribbon.seam_sign() * chain.eta.front())};
}

/// Stiffness of the penalty that makes pivots a valid second-order test: far above the strip's own
/// D w / l^3 (positions) and D w / l (rotations).
struct Penalty {
  double position, rotation;
};

Penalty penalties(const Ribbon& ribbon) {
  const double rigidity = ribbon.bending_stiffness * ribbon.width;
  const double position = 1e4 * rigidity / (ribbon.length * ribbon.length * ribbon.length);
  return {position, position * ribbon.length * ribbon.length / 40};
}

}  // namespace

void append_rows(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                 const std::vector<double>& multipliers, std::vector<ChainRow>& rows) {
  const Penalty penalty = penalties(ribbon);
  const std::size_t probes = rows.size();
  const auto push = [&](ChainRow row) {
    row.multiplier = multipliers[rows.size() - probes];
    rows.push_back(row);
  };
  if (problem.closed) {
    const Closure gap = closure(ribbon, chain, k);
    // With a floating base the penalty would couple it to the last node; the recursion has no room for that.
    const bool floating = !problem.base_fixed[0] || !problem.base_fixed[3];
    for (int c = 0; c < 8; ++c) {
      ChainRow row;
      row.node = ribbon.segments;
      if (c < 3) {
        row.v = Vec3::Unit(c);
        row.base_v = -row.v;
        row.residual = gap.gap[c];
        row.penalty = floating ? 0 : penalty.position;
      } else if (c < 6) {
        row.theta = Vec3::Unit(c - 3);
        row.base_theta = -row.theta;
        row.residual = gap.turn[c - 3];
        row.penalty = floating ? 0 : penalty.rotation;
      } else {
        row.u = Vec2::Unit(c - 6);
        row.first_u = -ribbon.seam_sign() * row.u;
        row.residual = gap.u[c - 6];
      }
      push(row);
    }
  }
  for (const Hold& hold : problem.holds) {
    for_each_row(hold, chain, k, [&](const Vec3& v, const Vec3& theta, double residual) {
      ChainRow row;
      row.node = hold.node;
      row.v = v;
      row.residual = residual;
      (hold.on_base ? row.base_theta : row.theta) = theta;
      // Rows on the base need none: its pivots are those of a small matrix, counted exactly.
      if (!v.isZero())
        row.penalty = penalty.position;
      else if (!hold.on_base)
        row.penalty = penalty.rotation;
      push(row);
    });
  }
}

std::size_t row_count(const Hold& hold) {
  std::size_t count = 0;
  for (const bool held : hold.position) count += held ? 1 : 0;
  if (hold.orientation == Orientation::full) count += 3;
  if (hold.orientation == Orientation::about_tangent) count += 1;
  return count;
}

std::size_t row_count(const ChainProblem& problem) {
  std::size_t count = problem.closed ? 8 : 0;
  for (const Hold& hold : problem.holds) count += row_count(hold);
  return count;
}

void constraint_residuals(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                          std::vector<double>& residuals) {
  residuals.clear();
  if (problem.closed) {
    const Closure gap = closure(ribbon, chain, k);
    residuals.insert(residuals.end(), gap.gap.begin(), gap.gap.end());
    residuals.insert(residuals.end(), gap.turn.begin(), gap.turn.end());
    residuals.insert(residuals.end(), gap.u.begin(), gap.u.end());
  }
  for (const Hold& hold : problem.holds) {
    for_each_row(hold, chain, k, [&](const Vec3&, const Vec3&, double residual) { residuals.push_back(residual); });
  }
}

}  // namespace wunderlich::solver
