#include "wunderlich/baseline/shell/step.hpp"

#include <chrono>
#include <cmath>

#include "wunderlich/baseline/shell/collide.hpp"

namespace wunderlich::baseline::shell {

namespace {

/// Seconds since the last call.
class Lap {
 public:
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Sparse implicit_matrix(const Shell& shell, const Hold& hold, const Sparse& to_unknowns, std::size_t axis, double h) {
  Sparse matrix = to_unknowns * shell.bending * Sparse(to_unknowns.transpose());
  Sparse mass(hold.unknown_count[axis], hold.unknown_count[axis]);
  mass.setIdentity();
  for (Eigen::Index k = 0; k < mass.rows(); ++k) mass.coeffRef(k, k) = hold.mass[axis][static_cast<std::size_t>(k)];
  return mass + h * h * matrix;
}

void prepare(const Shell& shell, const constraint::Surroundings& surroundings, double t0, double h, Work& work) {
  Hold hold = make_hold(shell, surroundings, t0);
  const bool same_hold = hold == work.hold && !work.lengths.empty();
  if (same_hold && std::abs(h - work.step) < 1e-9 * h) return;
  work.step = h;
  for (std::size_t a = 0; a < 3; ++a) {
    work.to_unknowns[a] = selection(hold, a).transpose();
    work.factor_of[a] = a > 0 && hold.unknown[a] == hold.unknown[0] ? 0 : a;
    if (work.factor_of[a] == a) {
      work.factor[a] = std::make_unique<Factor>(implicit_matrix(shell, hold, work.to_unknowns[a], a, h));
    }
  }
  if (same_hold) return;
  work.lengths.clear();
  for (const auto& set : shell.lengths) work.lengths.push_back(make_length_system(set, hold));
  work.boundary = make_boundary_system(shell.boundary, hold);
  work.hold = std::move(hold);
}

/// Implicit Euler of bending and loads without the constraints. Prescribed points move with their supports.
/// @eq Wardetzky2007
void predict(const Shell& shell, double h, double damping, Work& work, State& state) {
  const double kept = h / (1 + damping * h);
  Points right = h * h * (work.force - shell.bending * work.offset);
  for (Eigen::Index p = 0; p < right.rows(); ++p) {
    right.row(p) +=
        shell.mass[static_cast<std::size_t>(p)] * (state.x.row(p) + kept * state.v.row(p) - work.offset.row(p));
  }
  state.x = work.offset;
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::VectorXd reduced = work.to_unknowns[a] * right.col(static_cast<Eigen::Index>(a));
    add_change(work.hold, a, work.factor[work.factor_of[a]]->solve(reduced), state.x);
  }
}

double length_error(const Shell& shell, const Points& x) {
  double error = 0;
  for (const auto& set : shell.lengths) error = std::max(error, max_length_error(set, x));
  return error;
}

double boundary_error(const Shell& shell, const Points& x) {
  if (shell.boundary.rows() == 0) return 0;
  return Points(shell.boundary * x).rowwise().norm().maxCoeff() / shell.boundary_scale;
}

/// Both kinds of constraints in tandem, until both are within the tolerance.   @eq Goldenthal2007, Shen2015:6.6
bool enforce(const Shell& shell, const Options& options, Work& work, Points& x, StepReport& report) {
  Lap lap;
  while (report.iterations <= options.max_iterations) {
    while (length_error(shell, x) >= options.length_tolerance && report.iterations < options.max_iterations) {
      for (LengthSystem& system : work.lengths) {
        if (!project_lengths(system, work.hold, x)) return false;
      }
      ++report.iterations;
    }
    report.length_seconds += lap();
    if (length_error(shell, x) >= options.length_tolerance) return false;
    if (boundary_error(shell, x) < options.length_tolerance) return true;
    if (!project_boundary(work.boundary, shell.boundary, work.hold, x)) return false;
    ++report.boundary_iterations;
    report.boundary_seconds += lap();
  }
  return false;
}

}  // namespace

StepReport step(const Shell& shell, const constraint::Surroundings& surroundings, const Options& options, double t1,
                State& state, Work& work) {
  StepReport report;
  Lap lap;
  const double h = t1 - state.time;
  prepare(shell, surroundings, state.time, h, work);
  set_offset(shell, surroundings, state.time, t1, work.offset);
  work.force.setZero(shell.point_count(), 3);
  add_loads(shell, surroundings, state.x, t1, work.force);
  report.other_seconds += lap();

  State trial = state;
  predict(shell, h, options.damping, work, trial);
  report.sol_seconds = lap();
  report.converged = enforce(shell, options, work, trial.x, report);
  lap();
  report.touching = push_out(shell, surroundings, work.hold, state, t1, trial.x);
  trial.v = (trial.x - state.x) / h;
  trial.time = t1;
  report.max_length_error = length_error(shell, trial.x);
  report.accepted = trial.x.allFinite() && (report.converged || options.accept_inexact);
  if (report.accepted) state = std::move(trial);
  if (!report.accepted) report.failure = "fast projection did not reach the tolerance of the lengths";
  report.other_seconds += lap();
  return report;
}

State straight_state(const Shell& shell, const constraint::Surroundings& surroundings, double bulge) {
  State state;
  state.x = straight_points(shell);
  state.v.setZero(shell.point_count(), 3);
  for (int p = 0; p < shell.point_count(); ++p) {
    const double u = shell.flat[static_cast<std::size_t>(p)].x() / shell.strip.length;
    state.x(p, 2) += u > 0 && u < 1 ? bulge * std::sin(3.14159265358979323846 * u) : 0;
  }
  for (const constraint::Support& support : surroundings.supports) {
    if (support.node != 0 || support.segment > 0 || support.orientation != constraint::Orientation::full) continue;
    const Pose pose = constraint::pose_at(support.motion, 0);
    const Quat flat(Mat3{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}});  // d1 = +z, d2 = -y, d3 = +x
    const Mat3 turn = (pose.frame * flat.conjugate()).toRotationMatrix();
    state.x = ((turn * state.x.transpose()).colwise() + pose.position).transpose();
  }
  return state;
}

}  // namespace wunderlich::baseline::shell
