#include "wunderlich/solver/two_stage/contact.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/solver/two_stage/contact_solve.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/ode.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

constexpr double kGapTolerance = 1e-4;     // of a point, over the width
constexpr double kPairTolerance = 0.2;     // of a pair, over what it keeps
constexpr double kConeTolerance = 1e-6;    // of what forces close, over the largest gap at first
constexpr double kEnough = 0.03;           // of the gaps' tolerance, where forces are slow to find
constexpr int kMostSweeps = 100;           // of a small dense problem: what is left the next round takes up
constexpr double kLengthTolerance = 1e-7;  // |e|/l - 1
constexpr double kLongestTurn = 0.4;       // of an edge or a frame in one round [rad]

/// Share of work.motion that turns nothing too far and keeps |x| < 1.
double longest_motion(const Ribbon& ribbon, const geometry::State& shape, const Workspace& work) {
  double share = 1;
  const auto limit = [&](double size, double most) {
    if (size * share > most) share = most / size;
  };
  const std::size_t blocks = work.motion.size();
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const std::size_t next = s + 1 < blocks ? s + 1 : 0;
    const double rest = ribbon.rest_length[s];
    limit((work.motion[next] - work.motion[s]).head<3>().norm(), kLongestTurn * rest);
    limit(work.motion[s].segment<3>(kThetaPlace).norm(), kLongestTurn);
    const double slope = 0.5 * ribbon.width / rest, x = slope * (shape.eta[s + 1] - shape.eta[s]);
    const double sign = s + 1 < blocks ? 1 : ribbon.seam_sign();
    const double dx = slope * (sign * work.motion[next][kEtaPlace] - work.motion[s][kEtaPlace]);
    limit(std::abs(dx), kToBoundary * (dx > 0 ? 1 - x : 1 + x));
  }
  return share;
}

/// Velocity of the way that was gone, damped as stage ode does.
void set_velocity(const Ribbon& ribbon, const Options& options, double dt, State& state, Workspace& work) {
  for (std::size_t i = 0; i < state.shape.r.size(); ++i) {
    state.shape.r_dot[i] = (state.shape.r[i] - work.r_start[i]) / dt;
  }
  damp(ribbon, options.ode, dt, state.shape);
  if (ribbon.is_loop()) state.shape.r_dot.back() = state.shape.r_dot.front();
}

/// Largest gap to be closed.
double deepest(const Workspace& work) {
  double worst = 0;
  for (const Touch& touch : work.touches) worst = std::max(worst, touch.allowed - touch.gap);
  return worst;
}

void record(const Nearest& nearest, const Workspace& work, StepReport& report) {
  report.nearest = std::min(report.nearest, nearest.gap);
  report.push.setZero();
  report.touching = 0;
  for (const Touch& touch : work.touches) {
    report.touching += touch.push > 0;
    if (touch.solid != kItself) report.push += touch.push * touch.normal + touch.drag;
  }
}

/// What may be missing of a gap; pairs must not lose much of what they keep.
double gap_tolerance(const Ribbon& ribbon, const Workspace& work) {
  const bool pairs = work.corners.has_meshes || work.corners.has_cores || work.corners.self.active();
  const double of_width = kGapTolerance * ribbon.width;
  return pairs ? std::min(of_width, kPairTolerance * work.corners.margin) : of_width;
}

/// One linearisation: what touches and the equations, or the equations alone.
bool project_once(const Options& options, bool touches, double tolerance, double enough, Workspace& work,
                  StepReport& report) {
  if (options.opt.projection == Projection::gauss_seidel) {
    if (!touches) work.cones.size = 0;
    solve_contact_sweeps(tolerance, options.opt.max_sweeps, work, report);
    if (!touches) work.cones.force.clear();
    return true;
  }
  return touches ? solve_contact_direct(tolerance, enough, kMostSweeps, work, report) : solve_equations(work);
}

/// Rounds ended without an end: is what is left within bounds? Counts it, or says why not.
bool may_stay(const Ribbon& ribbon, const Options& options, const Nearest& nearest, const Workspace& work,
              StepReport& report) {
  if (nearest.passes) {
    report.failure = "contact: parts that would go through each other could not be kept apart";
    return false;
  }
  if (nearest.distance < -options.contact.most_penetration * ribbon.width || !std::isfinite(nearest.distance)) {
    report.failure = "contact: the strip could not be brought apart from what it touches";
    return false;
  }
  const bool loose = !(work.equations.worst_length <= options.opt.constraint_tolerance &&
                       work.equations.worst_angle <= options.opt.constraint_tolerance);
  if (loose && !options.opt.accept_inexact) {
    report.failure = "contact: lengths and rulings could not be restored";
    return false;
  }
  ++report.contact_unsettled;
  return true;
}

}  // namespace

bool settle_contact(const Ribbon& ribbon, const Drive& drive, const Options& options, double dt, State& state,
                    Workspace& work, StepReport& report) {
  if (drive.surroundings == nullptr) return true;
  if (drive.surroundings->obstacles.empty() && !drive.surroundings->contact.self) return true;
  const double t0 = work.before.time;
  set_surroundings(ribbon, *drive.surroundings, t0, t0 + dt, work);
  const double tolerance = gap_tolerance(ribbon, work);
  const bool swept = options.opt.projection == Projection::gauss_seidel;
  const double angle_tolerance = 0.1 * options.opt.constraint_tolerance;
  const double length_tolerance = swept ? angle_tolerance : kLengthTolerance;
  Nearest nearest = find_touches(ribbon, state.shape, 0, work);  // all that is inside, though it be little
  if (work.touches.empty() && !nearest.passes) {
    record(nearest, work, report);
    return true;
  }
  set_metric(ribbon, options, dt, work);
  bool settled = false, on_the_way = true;  // nothing has been projected, or not as far as it should go
  double close = 0;
  for (int round = 0; round < options.contact.max_rounds; ++round) {
    if (!assemble_equations(ribbon, options, state.shape, work)) break;
    assemble_touches(ribbon, state.shape, work);
    const double depth = deepest(work);
    const bool out = !on_the_way && depth <= tolerance;
    const bool equations_hold =
        work.equations.worst_length <= length_tolerance && work.equations.worst_angle <= angle_tolerance;
    settled = out && equations_hold && !nearest.passes;
    if (out && equations_hold) break;
    if (round == 0) close = swept ? 0.1 * angle_tolerance * ribbon.width : kConeTolerance * depth;
    if (!project_once(options, !out, close, kEnough * tolerance, work, report)) break;
    ++report.contact_rounds;
    const double share = longest_motion(ribbon, state.shape, work);
    keep_forces(share, work);
    move_all(ribbon, work.motion, share, work, state.shape);
    on_the_way = share < 1;
    nearest = find_touches(ribbon, state.shape, tolerance, work);
  }
  set_velocity(ribbon, options, dt, state, work);
  record(nearest, work, report);
  return settled || may_stay(ribbon, options, nearest, work, report);
}

}  // namespace wunderlich::solver::two_stage
