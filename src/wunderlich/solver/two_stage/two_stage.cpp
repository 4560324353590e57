#include "wunderlich/solver/two_stage/two_stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "wunderlich/energy/parallel_coupling.hpp"
#include "wunderlich/energy/torsional_inertia.hpp"
#include "wunderlich/solver/two_stage/contact.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/ode.hpp"
#include "wunderlich/solver/two_stage/opt.hpp"
#include "wunderlich/solver/two_stage/transport.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

constexpr int kSmallestLoop = 5;       // segments: links reach over four
constexpr double kMostSubsteps = 1e5;  // beyond this a step is a mistake in the units

using Clock = std::chrono::steady_clock;

/// Adds the time since the last call to a figure of the report.
struct StopWatch {
  Clock::time_point last = Clock::now();
  void add_to(double& seconds) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last).count();
    last = now;
  }
};

/// Why this cannot be simulated at all; nullptr if it can.
const char* unfit(const Ribbon& ribbon, const Drive& drive, const Options& options, double dt) {
  if (!(dt > 0)) return "the time step is not positive";
  if (ribbon.is_loop() && ribbon.segments < kSmallestLoop) return "a loop needs at least 5 segments";
  if (options.opt.central_rate && options.opt.minimiser == Minimiser::newton) {
    return "the central difference of eta needs the minimiser lbfgs";
  }
  for (const int end : {0, 1}) {
    bool held = false;
    for (const Support& s : drive.supports) {
      held = held || (s.orientation == constraint::Orientation::full && held_segment(ribbon, s) < 0 &&
                      s.node == end * ribbon.segments);
    }
    if (held != ribbon.clamped[static_cast<std::size_t>(end)]) {
      return "an end of the ribbon has a frame of its own without a clamp that holds it, or the other way round";
    }
  }
  return nullptr;
}

double weight_now(const Ribbon& ribbon, const Options& options, const geometry::State& shape) {
  if (options.ode.weight == ParallelWeight::rest) return rest_parallel_weight(ribbon, options.ode.weight_scale);
  return energy::parallel_weight(ribbon, options.model, shape, options.ode.weight_scale);
}

/// Weights of E_I on angle^2. The printed term is in the quaternion, half the angle.   @eq Shen2015:5.1
void set_inertia(const Ribbon& ribbon, const Options& options, double dt, Workspace& work) {
  work.inertia.assign(ribbon.rest_length.size(), 0.0);
  if (options.inertia == TorsionalInertia::off) return;
  for (std::size_t s = 0; s < work.inertia.size(); ++s) {
    const double inertia = energy::turn_inertia(ribbon, s);
    const double stiffness = work.parallel_weight / options.ode.weight_scale;
    work.inertia[s] =
        options.inertia_scale *
        (options.inertia == TorsionalInertia::physical ? 0.5 * inertia / (dt * dt) : 0.25 * stiffness / inertia);
  }
}

/// The drive at the end of the next of `left` substeps, on the way from where the strip stands.
void part_way(const Ribbon& ribbon, const Drive& drive, const State& state, int count, int left, Drive& out) {
  out = drive;
  if (count == 1) return;
  for (Support& support : out.supports) {
    const Vec3& from = state.shape.r[static_cast<std::size_t>(support.node)];
    support.position = from + (support.position - from) / left;
    support.turn /= count;
    if (support.orientation != constraint::Orientation::full) continue;
    const int segment = held_segment(ribbon, support);
    const Quat& frame = segment >= 0 ? state.shape.q[static_cast<std::size_t>(segment)]
                                     : state.shape.end_frame[support.node == 0 ? 0 : 1];
    support.frame = frame.slerp(1.0 / left, support.frame);
  }
}

bool edges_follow_frames(const Ribbon& ribbon, const geometry::State& shape) {
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    if (!((shape.r[s + 1] - shape.r[s]).dot(shape.q[s] * Vec3::UnitZ()) > 0)) return false;
  }
  return true;
}

/// The figures of constraint/errors.hpp without its allocations.
ConstraintErrors errors_now(const Ribbon& ribbon, const energy::Model& model, const geometry::State& shape,
                            Workspace& work) {
  ConstraintErrors out;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Vec3 edge = shape.r[s + 1] - shape.r[s];
    const double length = edge.norm();
    out.max_length_error = std::max(out.max_length_error, std::abs(length / ribbon.rest_length[s] - 1));
    out.max_parallel_error = std::max(out.max_parallel_error, (edge / length - shape.q[s] * Vec3::UnitZ()).norm());
  }
  refresh_strains(ribbon, model, shape, false, work);
  constraint_residual(ribbon, shape, work);
  for (std::size_t i = 0; i < work.residual.size(); i += 2) {
    out.max_binormal = std::max(out.max_binormal, std::abs(work.residual[i]));
    out.max_torsion_mismatch = std::max(out.max_torsion_mismatch, std::abs(work.residual[i + 1]));
  }
  out.max_ruling_ratio = largest_ruling_ratio(ribbon, shape);
  return out;
}

/// Turn about the tangent since the step's start, as a rate.
void record_spin(const Options& options, double dt, const Workspace& work, State& state) {
  if (options.inertia == TorsionalInertia::off) return;
  for (std::size_t s = 0; s < state.spin.size(); ++s) {
    const double angle = energy::turn_between(work.carried[s], state.shape.q[s]);
    state.spin[s] = work.holding.frame_held[s] ? 0 : state.spin[s] + angle / dt;
  }
}

/// One step of Algorithm 1.   @eq Shen2015:alg1 @eq Shen2015:19
bool substep(const Ribbon& ribbon, const Drive& drive, const Options& options, double dt, State& state, Workspace& work,
             StepReport& report) {
  StopWatch watch;
  set_up_holding(ribbon, drive, work);
  set_inertia(ribbon, options, dt, work);
  work.before = state.shape;
  watch.add_to(report.other_seconds);
  if (!advance_centerline(ribbon, drive, options.ode, dt, state.shape, work, report)) return false;
  watch.add_to(report.ode_seconds);
  transport_frames(ribbon, state.spin, dt, state.shape, work);
  set_held_frames(ribbon, drive, work.before, state.shape);
  follow_ends(ribbon, state.shape);
  watch.add_to(report.other_seconds);
  if (!edges_follow_frames(ribbon, state.shape)) {
    report.failure = "stage ode: an edge turned by more than 90 degrees against its frame; the time step is too long";
    return false;
  }
  const bool settled = settle_rulings(ribbon, options, state, work, report);
  watch.add_to(report.opt_seconds);
  if (!settled) return false;
  const bool clear = settle_contact(ribbon, drive, options, dt, state, work, report);
  watch.add_to(report.contact_seconds);
  if (!clear) return false;
  record_spin(options, dt, work, state);
  state.shape.time += dt;
  return true;
}

}  // namespace

State start(const Ribbon& ribbon, const geometry::State& shape) {
  State state;
  state.shape = shape;
  state.spin.assign(ribbon.rest_length.size(), 0.0);
  state.multipliers.assign(static_cast<std::size_t>(2 * block_count(ribbon)), 0.0);
  return state;
}

double rest_parallel_weight(const Ribbon& ribbon, double weight_scale) {
  // Second derivatives of V at the flat strip: D w/h of a hinge in kappa h and 2 D w/h in tau h, for both its segments;
  // those in a quaternion are 4 times those in its rotation vector. V does not depend on eta there.
  double sum = 0;
  for (std::size_t i = 0; i < ribbon.hinge_length.size(); ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    const bool at_end = !ribbon.is_loop() && (i == 0 || i + 1 == ribbon.hinge_length.size());
    sum += (at_end ? 1 : 2) * 4 * 3 * ribbon.bending_stiffness * ribbon.width / ribbon.hinge_length[i];
  }
  return weight_scale * sum / (4 * ribbon.segments + ribbon.node_count());
}

double stable_step(const Ribbon& ribbon, double parallel_weight) {
  double largest = 0;
  const std::size_t last = ribbon.rest_length.size();
  for (std::size_t i = 0; i <= last; ++i) {
    if (ribbon.node_mass[i] == 0) continue;
    double stiffness = 0;
    if (i < last) stiffness += 1 / (ribbon.rest_length[i] * ribbon.rest_length[i]);
    if (i > 0) stiffness += 1 / (ribbon.rest_length[i - 1] * ribbon.rest_length[i - 1]);
    if (i == 0 && ribbon.is_loop()) stiffness += 1 / (ribbon.rest_length.back() * ribbon.rest_length.back());
    largest = std::max(largest, 4 * parallel_weight * stiffness / ribbon.node_mass[i]);
  }
  return 2 / std::sqrt(largest);
}

StepReport step(const Ribbon& ribbon, const Drive& drive, const Options& options, double dt, State& state,
                Workspace& work) {
  StepReport report;
  StopWatch watch;
  if (const char* reason = unfit(ribbon, drive, options, dt)) {
    report.failure = reason;
    return report;
  }
  set_up_views(ribbon, work);
  work.parallel_weight = report.parallel_weight = weight_now(ribbon, options, state.shape);
  report.stable_step = stable_step(ribbon, work.parallel_weight);
  const double wanted = options.substeps ? std::ceil(dt / (options.bound_safety * report.stable_step)) : 1;
  report.exceeds_bound = dt / wanted > report.stable_step;
  if (!(wanted <= kMostSubsteps)) {
    report.failure = "the step is more than 100000 times longer than the stability bound";
    return report;
  }
  report.substeps = static_cast<int>(wanted);
  work.trial = state;
  bool converged = true;
  watch.add_to(report.other_seconds);
  for (int left = report.substeps; left > 0; --left) {
    part_way(ribbon, drive, work.trial, report.substeps, left, work.sub_drive);
    if (!substep(ribbon, work.sub_drive, options, dt / report.substeps, work.trial, work, report)) return report;
    converged = converged && report.converged;
  }
  watch.last = Clock::now();
  report.converged = converged;
  report.constraints = errors_now(ribbon, options.model, work.trial.shape, work);
  report.accepted = true;
  state = work.trial;
  watch.add_to(report.other_seconds);
  return report;
}

}  // namespace wunderlich::solver::two_stage
