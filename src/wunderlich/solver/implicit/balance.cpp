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
double support_work(const ChainProblem& problem, const Scheme& scheme, const State& state, const Chain& start,
                    const Workspace& work, const std::vector<double>& residuals) {
  const double after = late_share(scheme);
  double sum = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double before = i < state.path.multipliers.size() ? state.path.multipliers[i] : work.multipliers[i];
    sum += ((1 - after) * before + after * work.multipliers[i]) * residuals[i];
  }
  math::Vec6 way;
  way << start.base.position - state.path.chain.base.position,
      math::log_map(start.base.frame * state.path.chain.base.frame.conjugate());
  const math::Vec6 reaction = (1 - after) * state.base_reaction + after * work.newton.sweep.base_gradient;
  for (int c = 0; c < 6; ++c) {
    if (problem.base_fixed[static_cast<std::size_t>(c)]) sum += reaction[c] * way[c];
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

double work_done(const Ribbon& ribbon, const Scheme& scheme, const State& state, const Workspace& work) {
  return load_work(work.problem, state.points.x, work.x) + friction_work(work.problem.contact, work.newton.kinematics) +
         support_work(work.problem, scheme, state, work.start, work, work.residuals) +
         solid_work(ribbon, work.solids, work.before.points, work.problem.contact, work.newton.touching.points,
                    late_share(scheme));
}

void keep_conserved(const Ribbon& ribbon, const Options& options, double growth, State& state, Workspace& work) {
  const ChainProblem& problem = work.problem;
  const auto& fixed = problem.base_fixed;
  const bool held = !problem.holds.empty() || std::any_of(fixed.begin(), fixed.end(), [](bool is) { return is; });
  const bool pushed =
      !problem.loads.empty() || !problem.contact.empty() || options.drag_tangent > 0 || options.drag_normal > 0 ||
      std::any_of(problem.force.begin(), problem.force.end(), [](const Vec3& f) { return !f.isZero(0); });
  Conserved wanted;
  wanted.kinetic = kinetic_energy(ribbon, options.kinetic, work.points, state.path.chain.eta) - growth + state.missing;
  if (!held && !pushed) wanted.momentum = &state.momentum;
  find_held(ribbon, options, problem, work.conserve.held);
  state.missing = conserve(ribbon, options.kinetic, work.trial.eta, wanted, work.conserve, work.points);
  if (wanted.momentum == nullptr) state.momentum = momentum(ribbon, options.kinetic, work.points, work.trial.eta);
}

}  // namespace wunderlich::solver::implicit
