#include "wunderlich/solver/two_stage/lbfgs_loop.hpp"

#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/flat_region.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/projection.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// Between theta and the components of q: dq = theta / 2. L-BFGS works in q and eta, as printed.
void to_quaternion_gradient(std::vector<double>& gradient) {
  for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] *= i % 4 == 0 ? 1 : 2;
}
void to_angles(std::vector<double>& step) {
  for (std::size_t i = 0; i < step.size(); ++i) step[i] *= i % 4 == 0 ? 1 : 2;
}

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Gradient in (q, eta) at a state; false if it is not finite.
bool gradient_now(const Ribbon& ribbon, const Options& options, const geometry::State& shape, Workspace& work) {
  refresh_strains(ribbon, options.model, shape, true, work);
  objective_gradient(ribbon, options, shape, work);
  to_quaternion_gradient(work.gradient);
  return std::isfinite(norm(work.gradient));
}

/// What an iteration, projection included, changed in (q, eta).
void record_step(const Ribbon& ribbon, const geometry::State& shape, Workspace& work) {
  work.previous_step.assign(work.gradient.size(), 0.0);
  for (std::size_t b = 0; b < static_cast<std::size_t>(block_count(ribbon)); ++b) {
    work.previous_step[4 * b] = shape.eta[b] - work.lbfgs_eta[b];
    if (b >= shape.q.size()) continue;
    const Vec3 turn = 0.5 * math::log_map(work.lbfgs_q[b].conjugate() * shape.q[b]);
    for (std::size_t k = 0; k < 3; ++k) work.previous_step[4 * b + 1 + k] = turn[static_cast<Eigen::Index>(k)];
  }
}

/// Keeps the pair of the last iteration; returns how much the gradient changed.
double remember(Workspace& work) {
  work.gradient_change = work.gradient;
  for (std::size_t i = 0; i < work.gradient.size(); ++i) work.gradient_change[i] -= work.previous_gradient[i];
  work.memory.push(work.previous_step, work.gradient_change);
  return norm(work.gradient_change);
}

}  // namespace

bool minimise_lbfgs(const Ribbon& ribbon, const Options& options, geometry::State& shape, Workspace& work,
                    StepReport& report) {
  work.memory.reset(static_cast<std::size_t>(4 * block_count(ribbon)));
  bool feasible = project(ribbon, options, shape, work, report);
  double first = 0;  // gradient at the start: changes count against it
  for (int iteration = 0;; ++iteration) {
    if (!gradient_now(ribbon, options, shape, work)) {
      report.failure = "stage opt: the gradient is not finite";
      return false;
    }
    if (iteration == 0) {
      first = norm(work.gradient);
    } else {
      report.gradient_change = first > 0 ? remember(work) / first : 0;
      report.converged = feasible && report.gradient_change <= options.opt.gradient_change;
    }
    if (report.converged || iteration == options.opt.max_iterations) return true;
    work.previous_gradient = work.gradient;
    work.memory.direction(work.gradient, 1 / (8 * work.parallel_weight), work.step);
    to_angles(work.step);
    work.lbfgs_q = work.q_start = shape.q;
    work.lbfgs_eta = work.eta_start = shape.eta;
    const double longest = longest_step(ribbon, shape, work);
    report.cuts += longest < options.opt.step_size;
    move_unknowns(ribbon, work.step, std::min(options.opt.step_size, longest), work, shape);
    feasible = project(ribbon, options, shape, work, report);
    report.flattened += flatten_rulings(ribbon, options.opt.flat_curvature, shape, work);
    record_step(ribbon, shape, work);
    ++report.iterations;
  }
}

}  // namespace wunderlich::solver::two_stage
