#include "wunderlich/solver/implicit/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wunderlich/solver/newton_parts.hpp"

namespace wunderlich::solver::implicit {

namespace {

using Strips = std::span<const MovingStrip>;

constexpr double kHeld = 1e-13;     // of the rows (m, rad, 1) at the end of a step; lengths beyond 1 m count
constexpr int kUnsettled = 3;       // first iterations, in which what sticks and what slips sorts itself ...
constexpr double kSettling = 3e-4;  // ... unless steps are shorter than this

struct Iterate {
  Strips strips;
  const SelfContact& self;
  MinimiseWorkspace& work;
  bool conservative = true;  ///< have all loads a potential?
  bool rubs = false;         ///< is there friction?
  double emphasis = 1;       ///< of the rows' penalties in the merit
  std::size_t count() const { return strips.size(); }
};

void resize(Strips strips, MinimiseWorkspace& work) {
  if (work.strips.size() != strips.size()) work.strips.resize(strips.size());
  work.places.clear(), work.trial_places.clear(), work.parts.clear(), work.systems.clear();
  for (std::size_t i = 0; i < strips.size(); ++i) {
    NewtonWorkspace& own = work.strips[i];
    work.places.push_back({*strips[i].ribbon, own.current, own.kinematics});
    work.trial_places.push_back({*strips[i].ribbon, own.trial, own.trial_kinematics});
    work.parts.push_back({&own.system, &own.sweep, &own.step});
    work.systems.push_back(&own.system);
  }
}

/// Value of a strip as it lies, without what strips do to one another.
void add_contact_value(const ChainProblem& problem, const geometry::Ribbon& ribbon, const geometry::Kinematics& k,
                       const ContactPoints& points, ObjectiveValue& value) {
  if (problem.contact.empty()) return;
  value.contact = contact_energy(ribbon, problem.contact, points);
  value.friction = friction_value(problem.contact, k);
}

/// Kinematics and values of the iterates.
void value_iterates(const Iterate& at) {
  MinimiseWorkspace& work = at.work;
  const bool placed = std::exchange(work.placed, false);
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = work.strips[i];
    if (!placed) {
      geometry::forward_kinematics(*ribbon, own.current, own.kinematics);
      own.touching.points.clear();
      if (!problem->contact.empty()) {
        find_points(*ribbon, problem->contact, own.current, own.kinematics, own.touching.points);
      }
    }
    own.value = objective(*ribbon, *problem, own.current, own.kinematics, own.kinematics);
    add_contact_value(*problem, *ribbon, own.kinematics, own.touching.points, own.value);
  }
  if (at.self.active() && !placed) find_pairs(work.places, at.self, work.search, work.self);
}

/// The trials' places and values; false where something would be in their way.
bool value_trials(const Iterate& at, double scale) {
  MinimiseWorkspace& work = at.work;
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = work.strips[i];
    apply_step(own.current, own.step, scale, own.trial);
    geometry::forward_kinematics(*ribbon, own.trial, own.trial_kinematics);
    own.trial_value = objective(*ribbon, *problem, own.trial, own.trial_kinematics, own.kinematics);
    own.trial_touching.points.clear();
    if (problem->contact.empty()) continue;
    find_points(*ribbon, problem->contact, own.trial, own.trial_kinematics, own.trial_touching.points);
    if (!may_go(problem->contact, own.touching.points, own.trial_touching.points)) return false;
    add_contact_value(*problem, *ribbon, own.trial_kinematics, own.trial_touching.points, own.trial_value);
  }
  return !at.self.active() || travel(work.trial_places, at.self, work.self, work.search, work.trial_self);
}

/// What strips do to themselves and one another, of all that is minimised.
double self_value(const SelfContact& self, const SelfContacts& contacts) {
  return self.active() ? self_energy(self, contacts) + friction_value(self, contacts) : 0;
}

/// Everything that is minimised, of the trials.
double trial_total(const Iterate& at) {
  double sum = self_value(at.self, at.work.trial_self);
  for (const NewtonWorkspace& own : at.work.strips) sum += own.trial_value.total();
  return sum;
}

/// The trials become the iterates; loads are counted from here.
void move_on(MinimiseWorkspace& work) {
  for (NewtonWorkspace& own : work.strips) {
    std::swap(own.current, own.trial);
    std::swap(own.kinematics, own.trial_kinematics);
    std::swap(own.touching, own.trial_touching);
    own.value = own.trial_value;
    own.value.loads = 0;
  }
  std::swap(work.self, work.trial_self);
}

/// Has friction been looked at closely, and does its exact Hessian do better than a majorant?
bool is_settled(const NewtonReport& report) {
  return report.iterations > kUnsettled || (report.iterations > 1 && report.last_step < kSettling);
}

void linearise_all(const Iterate& at, bool settled) {
  MinimiseWorkspace& work = at.work;
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = work.strips[i];
    own.touching.points.settled = settled;
    linearise(*ribbon, *problem, own.current, own.kinematics, own.multipliers, own.touching, own.system);
    if (at.conservative) use_torsion_chart(*ribbon, own.current, own.system);
  }
  if (!at.self.active()) return;
  add_self_contact(work.places, at.self, work.self, work.systems, work.between);
  add_self_friction(work.places, at.self, work.self, settled, work.systems, work.between);
}

/// Solves; false if that fails or negative modes are left and would matter.
bool solve(const Iterate& at, double shift, bool geometric, bool any_modes, NewtonReport& report) {
  MinimiseWorkspace& work = at.work;
  for (std::size_t i = 0; i < at.count(); ++i) {
    set_shift(*at.strips[i].ribbon, shift, work.strips[i].system);
    work.strips[i].system.geometric = geometric;
  }
  ++report.sweeps;
  if (!math::chain_steps(work.parts, work.between)) return false;
  report.negative_modes = 0;
  for (const NewtonWorkspace& own : work.strips) report.negative_modes += own.step.negative_pivots;
  return any_modes || report.negative_modes == 0;
}

/// Without a shift, if need be without the terms that carry forces; or with the smallest shift of the series that
/// leaves no negative mode.
bool find_direction(const Iterate& at, double largest, NewtonReport& report, double& shift) {
  for (const bool geometric : {true, false}) {
    if (solve(at, 0, geometric, false, report)) {
      shift = 0;
      return true;
    }
  }
  shift = shift <= kSmallestShift ? 0 : shift / kShiftFactor;
  if (shift == 0 && at.conservative) shift = 100 * kSmallestShift;
  for (; shift < largest; shift = shift == 0 ? 100 * kSmallestShift : kShiftFactor * shift) {
    if (solve(at, shift, false, !at.conservative, report)) return true;
  }
  return false;
}

/// Measures the step; returns how much of it may be taken.
double measure(const Iterate& at, const NewtonOptions& options, NewtonReport& report) {
  double limit = 1;
  report.last_step = report.max_residual = 0;
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = at.work.strips[i];
    const double turn = measure_step(*ribbon, own, report);
    limit = std::min(limit, step_limit(*ribbon, options, own.current, own, turn));
    constraint_residuals(*ribbon, *problem, own.current, own.kinematics, own.residuals);
    const double residual = max_abs(own.residuals);
    if (!(residual <= report.max_residual)) report.max_residual = residual;
  }
  return limit;
}

/// Do the rows hold to rounding, after the last step? They are not linear in it.
bool rows_hold(const Iterate& at, NewtonReport& report) {
  bool hold = true;
  report.max_residual = 0;
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = at.work.strips[i];
    constraint_residuals(*ribbon, *problem, own.current, own.kinematics, own.residuals);
    const double residual = max_abs(own.residuals);
    hold = hold && residual <= kHeld * std::max(1.0, ribbon->length);
    report.max_residual = std::max(report.max_residual, residual);
  }
  return hold;
}

/// Merit of the iterates, and its slope.
struct Merit {
  double value = 0, slope = 0;
};

Merit merit_here(Iterate& at) {
  double infeasibility = 0, slope = 0;
  for (const NewtonWorkspace& own : at.work.strips) infeasibility += infeasibility_of(own), slope += slope_of(own, 1);
  at.emphasis = emphasis_of(infeasibility, slope);
  Merit merit{self_value(at.self, at.work.self), 0};
  for (const NewtonWorkspace& own : at.work.strips) {
    merit.value += merit_of(own, own.value, own.residuals, at.emphasis);
    merit.slope += slope_of(own, at.emphasis);
  }
  return merit;
}

double trial_merit(const Iterate& at) {
  double merit = self_value(at.self, at.work.trial_self);
  for (std::size_t i = 0; i < at.count(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = at.strips[i];
    NewtonWorkspace& own = at.work.strips[i];
    constraint_residuals(*ribbon, *problem, own.trial, own.trial_kinematics, own.trial_residuals);
    merit += merit_of(own, own.trial_value, own.trial_residuals, at.emphasis);
  }
  return merit;
}

/// Backtracks along the step on the merit function; leaves the accepted point in the trial buffers.
bool line_search(const Iterate& at, const Merit& start, double limit, NewtonReport& report) {
  const double rounding = 1e-13 * (std::abs(start.value) + std::abs(start.slope));
  for (double scale = limit; scale > 1e-10; scale *= 0.5) {
    ++report.evaluations;
    if (!value_trials(at, scale)) continue;
    const double merit = trial_merit(at);
    if (std::isfinite(merit) && merit <= start.value + 1e-4 * scale * start.slope + rounding) return true;
  }
  return false;
}

void take_multipliers(MinimiseWorkspace& work) {
  for (NewtonWorkspace& own : work.strips) {
    const auto probes = static_cast<std::ptrdiff_t>(own.system.probe_count());
    own.multipliers.assign(own.step.multiplier.begin() + probes, own.step.multiplier.end());
  }
}

void accept(const Iterate& at, NewtonReport& report) {
  report.outcome = NewtonOutcome::converged;
  report.value = {};
  for (std::size_t i = 0; i < at.count(); ++i) {
    const NewtonWorkspace& own = at.work.strips[i];
    report.value.elastic += own.value.elastic;
    report.value.barrier += own.value.barrier;
    report.value.ties += own.value.ties;
    report.value.contact += own.value.contact;
    report.value.friction += own.value.friction;
    *at.strips[i].chain = own.current;
    *at.strips[i].multipliers = own.multipliers;
  }
  if (!at.self.active()) return;
  report.value.contact += self_energy(at.self, at.work.self);
  report.value.friction += friction_value(at.self, at.work.self);
}

Iterate start(Strips strips, const SelfContact& self, MinimiseWorkspace& work) {
  Iterate at{strips, self, work};
  at.rubs = !self.rubs.empty();
  if (!work.placed) resize(strips, work);
  work.between.clear();
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const auto& [ribbon, problem, chain, multipliers, before] = strips[i];
    NewtonWorkspace& own = work.strips[i];
    own.current = *chain;
    multipliers->resize(row_count(*problem), 0.0);
    own.multipliers = *multipliers;
    at.conservative = at.conservative && problem->loads.empty();
    at.rubs = at.rubs || !problem->contact.friction.empty();
  }
  return at;
}

}  // namespace

bool place(Strips strips, const SelfContact& self, const SelfContacts& before, MinimiseWorkspace& work) {
  resize(strips, work);
  work.placed = false;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    NewtonWorkspace& own = work.strips[i];
    own.current = *strips[i].chain;
    geometry::forward_kinematics(*strips[i].ribbon, own.current, own.kinematics);
    own.touching.points.clear();
    const ContactProblem& contact = strips[i].problem->contact;
    if (contact.empty()) continue;
    find_points(*strips[i].ribbon, contact, own.current, own.kinematics, own.touching.points);
    if (!may_go(contact, *strips[i].before, own.touching.points)) return false;
  }
  return work.placed = !self.active() || travel(work.places, self, before, work.search, work.self);
}

NewtonReport minimise(Strips strips, const SelfContact& self, const NewtonOptions& options, MinimiseWorkspace& work) {
  NewtonReport report;
  Iterate at = start(strips, self, work);
  double shift = 0;
  int polished = 0;
  value_iterates(at);
  while (report.iterations < options.max_iterations) {
    ++report.iterations;
    const bool settled = !at.rubs || is_settled(report);
    linearise_all(at, settled);
    if (!find_direction(at, options.largest_shift, report, shift)) {
      report.outcome = NewtonOutcome::singular;
      return report;
    }
    const double limit = measure(at, options, report);
    // A shift makes steps short that are not the last ones.
    const bool small = limit == 1 && report.last_step * (1 + shift) < options.tolerance &&
                       report.max_residual < options.tolerance && settled;
    report.outcome = NewtonOutcome::line_search_failed;
    if (!at.conservative || small) {
      // Nothing to descend on, or nothing left to gain: full Newton steps, as far as they are bounded.
      ++report.evaluations;
      if (!value_trials(at, limit) || !std::isfinite(trial_total(at))) return report;
      take_multipliers(work);
      move_on(work);
      // One step more where the rows ask for it: what they were held to would add up over the steps in time.
      if (small && (rows_hold(at, report) || ++polished > 1)) {
        accept(at, report);
        return report;
      }
      continue;
    }
    const Merit merit = merit_here(at);
    if (!line_search(at, merit, limit, report)) return report;
    take_multipliers(work);
    move_on(work);
  }
  report.outcome = NewtonOutcome::iteration_limit;
  return report;
}

}  // namespace wunderlich::solver::implicit
