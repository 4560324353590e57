#include "support/kkt.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <cassert>
#include <cmath>
#include <variant>

#include "wunderlich/constraint/holding.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing::kkt {

using constraint::Load;
using constraint::LoadFrame;
using constraint::LoadKey;
using constraint::Orientation;
using constraint::Support;
using Eigen::VectorXd;
using geometry::r_index;
using geometry::Ribbon;
using geometry::State;
using geometry::theta_index;
using geometry::Triplets;

namespace {

using Any = std::variant<constraint::Parallel, constraint::Binormal, constraint::TorsionMatch, constraint::EndRulings,
                         constraint::LoopClosure, constraint::Pin, constraint::FrameClamp, constraint::TangentTurn>;

/// The segment a support holds; -1 for the frame of an end node, which is data and no unknown.
int held_segment(const Ribbon& ribbon, const Support& support) {
  if (support.segment >= 0) return support.segment;
  if (support.orientation == Orientation::full) return -1;
  return support.node == 0 ? 0 : ribbon.segments - 1;
}

/// The internal constraints, then the supports in order: a pin, then the orientation if a segment's.
std::vector<Any> constraints(const Problem& problem) {
  const auto strain = problem.model.strain;
  std::vector<Any> out{constraint::Parallel{}, constraint::Binormal{strain}, constraint::TorsionMatch{strain},
                       constraint::EndRulings{}, constraint::LoopClosure{}};
  for (const Support& support : problem.surroundings.supports) {
    const Pose pose = pose_at(support.motion, problem.time);
    const int segment = held_segment(problem.ribbon, support);
    out.push_back(constraint::Pin{support.node, pose.position, support.hold_position});
    if (support.orientation == Orientation::about_tangent) out.push_back(constraint::TangentTurn{segment, pose.frame});
    if (support.orientation == Orientation::full && segment >= 0) {
      out.push_back(constraint::FrameClamp{segment, pose.frame});
    }
  }
  return out;
}

int row_count(const Ribbon& ribbon, const Any& any) {
  return std::visit([&](const auto& c) { return rows(ribbon, c); }, any);
}

int total_rows(const Problem& problem) {
  int sum = 0;
  for (const Any& any : constraints(problem)) sum += row_count(problem.ribbon, any);
  return sum;
}

void set_end_frames(const Problem& problem, State& state) {
  for (const Support& support : problem.surroundings.supports) {
    if (support.orientation != Orientation::full || support.segment >= 0) continue;
    const std::size_t end = support.node == 0 ? 0 : 1;
    assert(problem.ribbon.clamped[end]);
    state.end_frame[end] = pose_at(support.motion, problem.time).frame;
  }
}

/// Gradient and tangent of one load. A torque has no potential: gradients taken in moving frames change by half
/// the commutator, which is skew, beside the load's own change.
void add_load(const Problem& problem, const State& state, const Load& load, VectorXd& gradient, Triplets& tangent) {
  const LoadKey key = load_at(load, problem.time);
  const bool material = load.frame == LoadFrame::material;
  const bool dead = !material && key.torque.isZero();
  const int segment = load.node == 0 ? 0 : problem.ribbon.segments - 1;
  assert(dead || load.node == 0 || load.node == problem.ribbon.segments);
  if (dead) {
    gradient.segment<3>(r_index(load.node)) -= key.force;
    return;
  }
  const Mat3 axes = state.q[static_cast<std::size_t>(segment)].toRotationMatrix();
  gradient.segment<3>(r_index(load.node)) -= material ? Vec3(axes * key.force) : key.force;
  if (material) {
    geometry::add_block(r_index(load.node), theta_index(segment), axes * math::skew(key.force), tangent);
  }
  const Vec3 torque = material ? key.torque : Vec3(axes.transpose() * key.torque);
  gradient.segment<3>(theta_index(segment)) -= torque;
  const double sign = material ? 0.5 : -0.5;
  geometry::add_block(theta_index(segment), theta_index(segment), sign * math::skew(torque), tangent);
}

/// The largest part of a step that keeps rotations below half a radian and |x| off 1.
double allowed_fraction(const Ribbon& ribbon, const State& state, const VectorXd& step) {
  double fraction = 1;
  for (int s = 0; s < ribbon.segments; ++s) {
    const auto k = static_cast<std::size_t>(s);
    const double scale = 0.5 * ribbon.width / ribbon.rest_length[k];
    const double x = scale * (state.eta[k + 1] - state.eta[k]);
    const double dx = scale * (step[geometry::eta_index(s + 1)] - step[geometry::eta_index(s)]);
    const double room = dx > 0 ? 1 - x : 1 + x;
    if (std::abs(dx) > 0.9 * room) fraction = std::min(fraction, 0.9 * room / std::abs(dx));
    const double turn = step.segment<3>(theta_index(s)).norm();
    if (turn > 0.5) fraction = std::min(fraction, 0.5 / turn);
  }
  return fraction;
}

double step_size(const Ribbon& ribbon, const VectorXd& step) {
  double largest = 0;
  for (int i = 0; i <= ribbon.segments; ++i) {
    largest = std::max(largest, step.segment<3>(r_index(i)).norm() / ribbon.length);
    largest = std::max(largest, std::abs(step[geometry::eta_index(i)]) * ribbon.width / ribbon.length);
    if (i < ribbon.segments) largest = std::max(largest, step.segment<3>(theta_index(i)).norm());
  }
  return step.allFinite() ? largest : std::numeric_limits<double>::infinity();
}

/// Solves with one refinement, which recovers the digits that mixed units cost.
VectorXd solve_linear(const Eigen::SparseMatrix<double>& matrix, const VectorXd& right) {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
  if (lu.info() != Eigen::Success) return VectorXd::Constant(right.size(), std::nan(""));
  VectorXd x = lu.solve(right);
  x += lu.solve(VectorXd(right - matrix * x));
  return x;
}

/// Multipliers that balance the gradient best at a state that is not yet an equilibrium.
VectorXd first_multipliers(const Problem& problem, const State& state) {
  const int size = geometry::chart_size(problem.ribbon), count = total_rows(problem);
  const System system = assemble(problem, state, VectorXd::Zero(count));
  Triplets triplets;
  for (int i = 0; i < size; ++i) triplets.emplace_back(i, i, 1.0);
  for (int column = 0; column < size; ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(system.matrix, column); it; ++it) {
      if (it.row() < size) continue;
      triplets.emplace_back(static_cast<int>(it.row()), column, it.value());
      triplets.emplace_back(column, static_cast<int>(it.row()), it.value());
    }
  }
  Eigen::SparseMatrix<double> matrix(size + count, size + count);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  VectorXd right = VectorXd::Zero(size + count);
  right.head(size) = -system.gradient;
  return solve_linear(matrix, right).tail(count);
}

}  // namespace

Eigen::MatrixXd System::hessian() const {
  const auto size = gradient.size();
  const Eigen::MatrixXd block = Eigen::MatrixXd(matrix).topLeftCorner(size, size);
  return 0.5 * (block + block.transpose());
}

Eigen::MatrixXd System::jacobian() const {
  return Eigen::MatrixXd(matrix).bottomLeftCorner(residual.size(), gradient.size());
}

System assemble(const Problem& problem, const State& state, const VectorXd& multipliers) {
  const Ribbon& ribbon = problem.ribbon;
  const int size = geometry::chart_size(ribbon), count = total_rows(problem);
  System system;
  system.gradient = VectorXd::Zero(size);
  system.residual = VectorXd::Zero(count);
  Triplets matrix, jacobian;
  energy::add_elastic_gradient(ribbon, problem.model, state, system.gradient);
  energy::add_elastic_hessian(ribbon, problem.model, state, matrix);
  energy::add_barrier_gradient(ribbon, problem.barrier, state, system.gradient);
  energy::add_barrier_hessian(ribbon, problem.barrier, state, matrix);
  energy::add_gravity_gradient(ribbon, problem.surroundings.gravity, system.gradient);
  for (const Load& load : problem.surroundings.loads) add_load(problem, state, load, system.gradient, matrix);
  int row = 0;
  for (const Any& any : constraints(problem)) {
    const int rows_here = row_count(ribbon, any);
    std::visit(
        [&](const auto& c) {
          residual(ribbon, c, state, system.residual.segment(row, rows_here));
          add_jacobian(ribbon, c, state, row, jacobian);
          add_hessian(ribbon, c, state, multipliers.segment(row, rows_here), matrix);
        },
        any);
    row += rows_here;
  }
  for (const auto& entry : jacobian) {
    system.gradient[entry.col()] += entry.value() * multipliers[entry.row()];
    matrix.emplace_back(size + entry.row(), entry.col(), entry.value());
    matrix.emplace_back(entry.col(), size + entry.row(), entry.value());
  }
  system.matrix.resize(size + count, size + count);
  system.matrix.setFromTriplets(matrix.begin(), matrix.end());
  return system;
}

Solution solve(const Problem& problem, const State& start, double tolerance, int max_iterations) {
  Solution out;
  out.state = start;
  set_end_frames(problem, out.state);
  out.multipliers = first_multipliers(problem, out.state);
  const int size = geometry::chart_size(problem.ribbon);
  while (out.iterations < max_iterations && !out.converged && out.multipliers.allFinite()) {
    const System system = assemble(problem, out.state, out.multipliers);
    VectorXd right(size + system.residual.size());
    right << -system.gradient, -system.residual;
    const VectorXd step = solve_linear(system.matrix, right);
    out.last_step = step_size(problem.ribbon, step.head(size));
    if (!std::isfinite(out.last_step)) break;
    const double fraction = allowed_fraction(problem.ribbon, out.state, step.head(size));
    geometry::move(problem.ribbon, fraction * step.head(size), out.state);
    out.multipliers += fraction * step.tail(out.multipliers.size());
    ++out.iterations;
    out.converged = fraction == 1 && out.last_step <= tolerance;
  }
  return out;
}

Response response(const Problem& problem, const Solution& solution, const VectorXd& force) {
  const Ribbon& ribbon = problem.ribbon;
  const int size = geometry::chart_size(ribbon);
  const System system = assemble(problem, solution.state, solution.multipliers);
  VectorXd right = VectorXd::Zero(system.matrix.rows());
  right.head(size) = force;
  const VectorXd x = solve_linear(system.matrix, right);
  Response out{x.head(size), x.tail(system.residual.size()), std::vector<double>(ribbon.hinge_length.size(), 0.0)};
  for (const geometry::Hinge& hinge : geometry::hinges(ribbon)) {
    const auto jet = hinge_jet(ribbon, solution.state, hinge, problem.model.strain);
    double& kappa = out.kappa[static_cast<std::size_t>(hinge.node)];
    if (hinge.before >= 0) kappa += jet.before.row(1).dot(out.chart.segment<3>(theta_index(hinge.before)));
    if (hinge.after >= 0) kappa += jet.after.row(1).dot(out.chart.segment<3>(theta_index(hinge.after)));
  }
  return out;
}

Inertia inertia(const Problem& problem, const Solution& solution) {
  const System system = assemble(problem, solution.state, solution.multipliers);
  Eigen::MatrixXd transposed = system.jacobian().transpose();
  for (auto column : transposed.colwise()) column.normalize();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  const Eigen::Index rank = qr.rank(), size = transposed.rows();
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd free = q.rightCols(size - rank);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(free.transpose() * system.hessian() * free,
                                                             Eigen::EigenvaluesOnly);
  Inertia out;
  out.rank_loss = static_cast<int>(transposed.cols() - rank);
  out.eigenvalues = eigen.eigenvalues();
  out.negative = static_cast<int>((out.eigenvalues.array() < 0).count());
  return out;
}

Vec3 pin_force(const Problem& problem, const Solution& solution, int node) {
  int row = 0;
  for (const Any& any : constraints(problem)) {
    const auto* pin = std::get_if<constraint::Pin>(&any);
    if (pin && pin->node == node) {
      Vec3 force = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        if (pin->axes[static_cast<std::size_t>(k)]) force[k] = -solution.multipliers[row++];
      }
      return force;
    }
    row += row_count(problem.ribbon, any);
  }
  assert(false && "no pin at this node");
  return Vec3::Zero();
}

}  // namespace wunderlich::testing::kkt
