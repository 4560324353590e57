#include "wunderlich/solver/implicit/balance.hpp"

#include <algorithm>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver::implicit {

using geometry::Chain;
using geometry::Ribbon;

namespace {

/// Weight of the forces at a step's end.
double late_share(const Scheme& scheme) { return scheme.kind == Integrator::bdf2 ? 0.5 : 1 - scheme.alpha_f; }

/// Of what moves the supports. Euler takes the reactions after for the whole step.
double support_work(const Scheme& scheme, const StripState& state, const math::Vec6& base_reaction,
                    const StripWorkspace& work) {
  const double after = late_share(scheme);
  double sum = 0;
  for (std::size_t i = 0; i < work.residuals.size(); ++i) {
    const double before = i < state.path.multipliers.size() ? state.path.multipliers[i] : work.multipliers[i];
    sum += ((1 - after) * before + after * work.multipliers[i]) * work.residuals[i];
  }
  math::Vec6 way;
  way << work.start.base.position - state.path.chain.base.position,
      math::log_map(work.start.base.frame * state.path.chain.base.frame.conjugate());
  const math::Vec6 reaction = (1 - after) * state.base_reaction + after * base_reaction;
  for (int c = 0; c < 6; ++c) {
    if (work.problem.base_fixed[static_cast<std::size_t>(c)]) sum += reaction[c] * way[c];
  }
  return sum;
}

/// Of the dead forces from x0 to x1.
double load_work(const ChainProblem& problem, const std::vector<Vec3>& x0, const std::vector<Vec3>& x1) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.force.size(); ++i) sum += problem.force[i].dot(x1[i] - x0[i]);
  return sum;
}

/// Points that supports move.
void find_held(const Ribbon& ribbon, const Options& options, const ChainProblem& problem,
               std::vector<std::size_t>& held) {
  held.clear();
  const auto n = static_cast<std::size_t>(ribbon.segments);
  const auto& fixed = problem.base_fixed;
  if (fixed[0] && fixed[1] && fixed[2]) held.push_back(0);
  for (const Hold& hold : problem.holds) {
    const auto node = static_cast<std::size_t>(hold.node);
    if (hold.position[0] && hold.position[1] && hold.position[2]) held.push_back(node);
    const bool turns = hold.orientation == constraint::Orientation::full && node < n;
    if (turns && options.kinetic != KineticEnergy::centerline) held.push_back(n + 1 + node);
  }
}

}  // namespace

double work_done(Paths paths, const Scheme& scheme, const State& state, const Workspace& work) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const StripWorkspace& own = work.strips[i];
    const NewtonWorkspace& newton = work.newton.strips[i];
    sum += load_work(own.problem, state.strips[i].points.x, own.x) +
           friction_work(own.problem.contact, newton.kinematics) +
           support_work(scheme, state.strips[i], newton.sweep.base_gradient, own) +
           solid_work(paths[i].ribbon, own.solids, own.before, own.problem.contact, newton.touching.points,
                      late_share(scheme));
  }
  return sum;
}

void keep_conserved(const Ribbon& ribbon, const Options& options, double growth, State& all, Workspace& workspace) {
  StripState& state = all.strips.front();
  StripWorkspace& work = workspace.strips.front();
  const ChainProblem& problem = work.problem;
  const auto& fixed = problem.base_fixed;
  const bool held = !problem.holds.empty() || std::any_of(fixed.begin(), fixed.end(), [](bool is) { return is; });
  const bool pushed =
      !problem.loads.empty() || !problem.contact.empty() || options.drag_tangent > 0 || options.drag_normal > 0 ||
      std::any_of(problem.force.begin(), problem.force.end(), [](const Vec3& f) { return !f.isZero(0); });
  Conserved wanted;
  wanted.kinetic = kinetic_energy(ribbon, options.kinetic, work.points, state.path.chain.eta) - growth + all.missing;
  if (!held && !pushed) wanted.momentum = &state.momentum;
  find_held(ribbon, options, problem, work.conserve.held);
  all.missing = conserve(ribbon, options.kinetic, work.trial.eta, wanted, work.conserve, work.points);
  if (wanted.momentum == nullptr) state.momentum = momentum(ribbon, options.kinetic, work.points, work.trial.eta);
}

}  // namespace wunderlich::solver::implicit
