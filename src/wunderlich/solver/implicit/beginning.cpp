#include "wunderlich/solver/implicit/beginning.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/load_step.hpp"
#include "wunderlich/solver/path_step.hpp"

namespace wunderlich::solver::implicit {

using geometry::Chain;
using geometry::Ribbon;

namespace {

constexpr double kFlat = 1e-4;             // curvature over 1/length that counts as none
constexpr double kBoundaryFraction = 0.5;  // how far the prediction may move |x| towards 1

/// Joint coordinates carried on as in the last step; less far where rulings would meet.
void predict(const Ribbon& ribbon, const StripState& state, double h, double last_step, Chain& chain) {
  chain = state.path.chain;
  if (last_step == 0) return;
  const Chain& now = state.path.chain;
  double share = h / last_step;
  for (std::size_t s = 0; s + 1 < now.eta.size(); ++s) {
    const double k = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = k * (now.eta[s + 1] - now.eta[s]);
    const double dx = x - k * (state.before.eta[s + 1] - state.before.eta[s]);
    const double room = kBoundaryFraction * (dx > 0 ? 1 - x : 1 + x);
    if (share * std::abs(dx) > room) share = room / std::abs(dx);
  }
  for (std::size_t i = 0; i < now.kappa.size(); ++i) {
    chain.kappa[i] += share * (now.kappa[i] - state.before.kappa[i]);
    chain.eta[i] += share * (now.eta[i] - state.before.eta[i]);
  }
  const Vec3 turn = math::log_map(now.base.frame * state.before.base.frame.conjugate());
  chain.base.position += share * (now.base.position - state.before.base.position);
  chain.base.frame = math::exp_map(share * turn) * now.base.frame;
}

/// What is held of the base is where it is held.
void keep_held(const ChainProblem& problem, const Pose& held, Pose& base) {
  for (int c = 0; c < 3; ++c) {
    if (problem.base_fixed[static_cast<std::size_t>(c)]) base.position[c] = held.position[c];
  }
  if (problem.base_fixed[3]) base.frame = held.frame;
}

bool feels_anything(const Workspace& work) {
  const auto feels = [](const StripWorkspace& own) { return !own.problem.contact.empty(); };
  return work.self.active() || std::any_of(work.strips.begin(), work.strips.end(), feels);
}

}  // namespace

void set_problems(Paths paths, const Options& options, const Scheme& scheme, double t1, const State& state,
                  Workspace& work) {
  work.self = {};
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const StripState& strip = state.strips[i];
    ChainProblem& problem = work.strips[i].problem;
    problem_at(paths[i], strip.path, t1, work.strips[i].trial, problem);
    problem.barrier = problem.wall = options.barrier;
    if (paths[i].surroundings.supports.empty()) problem.base_fixed.fill(false);
    tie(paths[i].ribbon, options.kinetic, scheme, strip.points, strip.path.chain.eta, problem);
    problem.viscosity = options.viscosity / scheme.h;
    problem.before = options.viscosity > 0 ? &strip.path.chain : nullptr;
    if (problem.self.active()) place_beside(problem.self, work.self);
  }
}

void find_contacts(Paths paths, const State& state, Workspace& work) {
  std::vector<StripPlace> places;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripWorkspace& own = work.strips[i];
    const Chain& chain = state.strips[i].path.chain;
    own.before.clear();
    place_solids(paths[i].ribbon, paths[i].surroundings, state.time(), own.solids);
    geometry::forward_kinematics(paths[i].ribbon, chain, own.kinematics);
    if (!own.solids.empty()) find_points(paths[i].ribbon, own.solids, chain, own.kinematics, own.before);
    if (work.self.active()) places.push_back({paths[i].ribbon, chain, own.kinematics});
  }
  if (work.self.active()) find_pairs(places, work.self, work.newton.search, work.self_before);
}

void prepare(Paths paths, const Options& options, const Scheme& scheme, double t1, const State& state,
             Workspace& work) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Chain& trial = work.strips[i].trial;
    predict(paths[i].ribbon, state.strips[i], scheme.h, state.last_step, trial);
    // Between two held places a flat strip has no direction to go in: Newton's method starts beside it.
    const bool held = paths[i].surroundings.supports.size() > 1;
    if (held && is_flat(trial, paths[i].ribbon.length, kFlat)) seed(paths[i].ribbon, trial);
  }
  set_problems(paths, options, scheme, t1, state, work);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Ribbon& ribbon = paths[i].ribbon;
    const PathState& path = state.strips[i].path;
    StripWorkspace& own = work.strips[i];
    own.multipliers = path.multipliers;
    own.multipliers.resize(row_count(own.problem), 0.0);
    // How far the supports have moved: the rows' residuals before the step.
    own.start = path.chain;
    own.start.base = own.trial.base;
    if (!own.multipliers.empty()) geometry::forward_kinematics(ribbon, path.chain, own.kinematics);
    constraint_residuals(ribbon, own.problem, path.chain, own.kinematics, own.residuals);
  }
}

std::span<const MovingStrip> moving(Paths paths, Workspace& work) {
  work.moving.clear();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripWorkspace& own = work.strips[i];
    work.moving.push_back({&paths[i].ribbon, &own.problem, &own.trial, &own.multipliers, &own.before});
  }
  return work.moving;
}

bool start_clear(Paths paths, const State& state, double h, Workspace& work) {
  if (!feels_anything(work)) return true;
  find_contacts(paths, state, work);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripWorkspace& own = work.strips[i];
    set_friction(paths[i].ribbon, own.solids, own.before, state.strips[i].path.chain, own.kinematics, h,
                 own.problem.contact);
  }
  if (work.self.active()) set_friction(work.self_before, h, work.self);
  const auto strips = moving(paths, work);
  const auto is_clear = [&] { return place(strips, work.self, work.self_before, work.newton); };
  if (is_clear()) return true;
  std::vector<Pose> held;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    StripWorkspace& own = work.strips[i];
    held.push_back(own.trial.base);
    own.trial = state.strips[i].path.chain;
    keep_held(own.problem, held[i], own.trial.base);
  }
  if (is_clear()) return true;
  // Carried along by one of the solids?
  const auto goes_with = [&](const Pose& from, const Pose& to) {
    const Quat turn = to.frame * from.frame.conjugate();
    for (std::size_t i = 0; i < paths.size(); ++i) {
      StripWorkspace& own = work.strips[i];
      const Pose& base = state.strips[i].path.chain.base;
      own.trial.base.position = to.position + turn * (base.position - from.position);
      own.trial.base.frame = turn * base.frame;
      keep_held(own.problem, held[i], own.trial.base);
    }
    return is_clear();
  };
  const ContactProblem &before = work.strips.front().solids, &after = work.strips.front().problem.contact;
  for (std::size_t k = 0; k < before.solids.size(); ++k) {
    if (goes_with(before.solids[k].pose, after.solids[k].pose)) return true;
  }
  for (std::size_t k = 0; k < before.meshes.solids.size(); ++k) {
    if (goes_with(before.meshes.solids[k].pose, after.meshes.solids[k].pose)) return true;
  }
  return false;
}

}  // namespace wunderlich::solver::implicit
