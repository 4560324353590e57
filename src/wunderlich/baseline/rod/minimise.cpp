#include "wunderlich/baseline/rod/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wunderlich::baseline::rod {

namespace {

constexpr double kLargestBend = 0.8;  // change of an edge in one iteration, over its rest length
constexpr double kLargestTurn = 1;    // of a section [rad]
constexpr double kLeastShift = 1e-4;  // over soft/length^4: what needs no more is neutral to rounding
constexpr int kMostShifts = 24, kMostHalvings = 40, kMostKicks = 30;

/// Adds a term's derivatives by the coordinates `at`, which need not be unknowns, nor different ones.
template <int N, class Coordinates>
void add_term(const Unknowns& u, const Coordinates& at, const Eigen::Matrix<double, N, 1>& gradient,
              const Eigen::Matrix<double, N, N>& hessian, System& system) {
  for (int k = 0; k < N; ++k) {
    const int row = u.number[at[static_cast<std::size_t>(k)]];
    if (row < 0) continue;
    double slope = gradient[k];
    for (int c = 0; c < N; ++c) slope += hessian(k, c) * u.given[at[static_cast<std::size_t>(c)]];
    system.gradient[static_cast<std::size_t>(row)] += slope;
    for (int c = 0; c < k; ++c) {
      const int column = u.number[at[static_cast<std::size_t>(c)]];
      if (column >= 0) system.hessian.at(row, column) += (row == column ? 2 : 1) * hessian(k, c);
    }
    system.hessian.at(row, row) += hessian(k, k);
  }
}

template <std::size_t N>
std::array<std::size_t, N> from(std::size_t first) {
  std::array<std::size_t, N> out;
  for (std::size_t k = 0; k < N; ++k) out[k] = first + k;
  return out;
}

void add_stretching(const Rod& rod, const State& state, const Unknowns& u, System& system) {
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const EdgeTerms t = edge_terms(rod, state, j);
    Eigen::Matrix<double, 6, 1> gradient;
    gradient << -t.gradient, t.gradient;
    Eigen::Matrix<double, 6, 6> hessian;
    hessian << t.hessian, -t.hessian, -t.hessian, t.hessian;
    const std::size_t i = 4 * j;
    add_term<6>(u, std::array<std::size_t, 6>{i, i + 1, i + 2, i + 4, i + 5, i + 6}, gradient, hessian, system);
  }
}

void add_ties(const Rod& rod, const Objective& objective, const State& state, const Unknowns& u, System& system) {
  const bool tied = !objective.node_tie.empty();
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    Mat3 tie = Mat3::Zero();
    Vec3 slope = -objective.force[i];
    if (tied) {
      tie = objective.node_tie[i];
      slope += tie * (state.x[i] - objective.node_goal[i]);
    }
    add_term<3>(u, from<3>(4 * i), slope, tie, system);
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    double tie = 0, slope = -objective.moment[j];
    if (tied) {
      tie = objective.edge_tie[j];
      slope += tie * (state.theta[j] - objective.edge_goal[j]);
    }
    using One = Eigen::Matrix<double, 1, 1>;
    add_term<1>(u, from<1>(4 * j + 3), One(slope), One(tie), system);
  }
}

void add_barrier(const Rod& rod, const Objective& objective, const State& state, const Unknowns& u, System& system) {
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    TouchTerms t{Vec7::Zero(), Mat7::Zero()};
    if (barrier_energy(rod, objective.solids, state, j, &t) != 0)
      add_term<7>(u, from<7>(4 * j), t.gradient, t.hessian, system);
  }
}

/// What a shift of the Hessian is measured by: lengths, for turns of sections times their radius of gyration squared.
void find_metric(const Rod& rod, const Unknowns& u, std::vector<double>& metric) {
  metric.assign(static_cast<std::size_t>(u.count), 0.0);
  const double gyration = rod.width * rod.width / 12;
  const auto add = [&](std::size_t coordinate, double amount) {
    if (u.number[coordinate] >= 0) metric[static_cast<std::size_t>(u.number[coordinate])] += amount;
  };
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    for (std::size_t c = 0; c < 3; ++c) {
      add(4 * j + c, 0.5 * rod.rest_length[j]);
      add(4 * j + 4 + c, 0.5 * rod.rest_length[j]);
    }
    add(4 * j + 3, gyration * rod.rest_length[j]);
  }
}

/// Factors the Hessian with a shift; returns the number of negative modes, at least 1 where it cannot be factored.
int factor_with(double shift, Workspace& work) {
  work.factors = work.system.hessian;
  for (int k = 0; k < work.factors.size; ++k) work.factors.at(k, k) += shift * work.metric[static_cast<std::size_t>(k)];
  const math::Inertia inertia = math::factor(work.factors);
  return inertia.sound ? inertia.negative : std::max(1, inertia.negative);
}

/// Factors the Hessian with the least shift tried that makes it positive; `shift` starts from that of the last time.
/// False if none does.
bool factor_shifted(const Rod& rod, Workspace& work, double& shift, Report& report) {
  const double length = rod.length, least = kLeastShift * rod.stiffness.soft / (length * length * length * length);
  double next = std::max(0.1 * shift, least);
  shift = 0;
  for (int tries = 0; tries < kMostShifts; ++tries) {
    const int negative = factor_with(shift, work);
    ++report.factorisations;
    if (tries == 0) report.negative_modes = negative;
    if (negative == 0) return true;
    shift = next;
    next *= 10;
  }
  return false;
}

/// Increments of all coordinates from those of the unknowns.
void expand(const Unknowns& u, const std::vector<double>& step, double given, std::vector<double>& increment) {
  increment.resize(u.number.size());
  for (std::size_t c = 0; c < u.number.size(); ++c) {
    increment[c] = given * u.given[c] + (u.number[c] >= 0 ? step[static_cast<std::size_t>(u.number[c])] : 0.0);
  }
}

/// Largest displacement over the length, or turn; and the share of the increment that bends no edge too much.
struct Size {
  double step = 0, share = 1;
};
Size size_of(const Rod& rod, const std::vector<double>& increment) {
  Size size;
  const auto node = [&](std::size_t i) { return Vec3(increment[4 * i], increment[4 * i + 1], increment[4 * i + 2]); };
  double most = 1;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const double turn = std::abs(increment[4 * j + 3]);
    most = std::max({most, turn / kLargestTurn, (node(j + 1) - node(j)).norm() / (kLargestBend * rod.rest_length[j])});
    size.step = std::max({size.step, turn, node(j + 1).norm() / rod.length, node(j).norm() / rod.length});
  }
  size.share = 1 / most;
  return size;
}

void take_shape(State& state, State& trial) {
  std::swap(state.x, trial.x);
  std::swap(state.theta, trial.theta);
  std::swap(state.reference, trial.reference);
  std::swap(state.reference_twist, trial.reference_twist);
}

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Moves what supports move: with all else going along as the linearised rod would, or staying, whichever has less
/// energy. False if either way is barred.
bool follow_supports(const Rod& rod, bool predict, State& state, Workspace& work, Report& report) {
  const Objective& objective = work.objective;
  const bool moved =
      std::any_of(work.unknowns.given.begin(), work.unknowns.given.end(), [](double x) { return x != 0; });
  if (!moved) return true;
  work.step.assign(static_cast<std::size_t>(work.unknowns.count), 0.0);
  expand(work.unknowns, work.step, 1, work.increment);
  if (size_of(rod, work.increment).share < 0.5) return false;
  move(rod, state, work.increment, 1, work.trial);
  const double staying = value(rod, objective, work.trial);
  double going = std::numeric_limits<double>::infinity(), shift = 0;
  if (predict) assemble(rod, objective, state, work.unknowns, work.system);
  if (predict && factor_shifted(rod, work, shift, report)) {
    for (std::size_t k = 0; k < work.step.size(); ++k) work.step[k] = -work.system.gradient[k];
    math::solve(work.factors, work.step);
    expand(work.unknowns, work.step, 1, work.increment);
    if (size_of(rod, work.increment).share == 1) {
      move(rod, state, work.increment, 1, work.other);
      going = value(rod, objective, work.other);
    }
  }
  std::fill(work.unknowns.given.begin(), work.unknowns.given.end(), 0.0);
  take_shape(state, going < staying ? work.other : work.trial);
  return std::isfinite(std::min(going, staying));
}

/// Takes the step if it lowers the value, or a share of it. Rounding apart, it must.
bool search(const Rod& rod, double share, double start, State& state, Workspace& work, double& now) {
  double slope = 0;
  for (std::size_t k = 0; k < work.step.size(); ++k) slope += work.step[k] * work.system.gradient[k];
  const double rounding = 1e-13 * std::abs(start);
  for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
    move(rod, state, work.increment, share, work.trial);
    now = value(rod, work.objective, work.trial);
    if (now <= start + 1e-4 * share * slope + rounding) {
      take_shape(state, work.trial);
      return true;
    }
    const double least = -0.5 * slope * share * share / (now - start - slope * share);  // of the parabola
    share = std::isfinite(least) ? std::clamp(least, 0.1 * share, 0.5 * share) : 0.5 * share;
  }
  return false;
}

/// Leaves a saddle along its softest mode, found by inverse iteration, to the lower side. `shift` makes the Hessian
/// positive; it is narrowed down first, for then the softest mode stands out.
bool kick(const Rod& rod, double shift, double start, State& state, Workspace& work, double& now) {
  double low = 0.01 * shift, high = shift;
  for (int pass = 0; pass < 8; ++pass) {
    const double middle = std::sqrt(low * high);
    (factor_with(middle, work) == 0 ? high : low) = middle;
  }
  factor_with(high, work);
  work.mode.resize(work.metric.size());
  for (std::size_t k = 0; k < work.mode.size(); ++k) work.mode[k] = std::sin(1.0 + 7.0 * static_cast<double>(k));
  for (int pass = 0; pass < 12; ++pass) {
    const double size = norm(work.mode);
    for (std::size_t k = 0; k < work.mode.size(); ++k) work.mode[k] *= work.metric[k] / size;
    math::solve(work.factors, work.mode);
  }
  expand(work.unknowns, work.mode, 0, work.increment);
  double amount = 1e-2 / size_of(rod, work.increment).step;
  for (int halvings = 0; halvings < 20; ++halvings, amount *= 0.5) {
    const double bound = std::min(amount, size_of(rod, work.increment).share);
    move(rod, state, work.increment, bound, work.trial);
    move(rod, state, work.increment, -bound, work.other);
    const double up = value(rod, work.objective, work.trial), down = value(rod, work.objective, work.other);
    now = std::min(up, down);
    if (now >= start) continue;
    take_shape(state, up < down ? work.trial : work.other);
    return true;
  }
  return false;
}

}  // namespace

const char* outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::iteration_limit:
      return "iteration limit";
    case Outcome::line_search_failed:
      return "no step lowers the energy";
    case Outcome::blocked:
      return "a support moves too far, or a solid is in the way";
  }
  return "";
}

double value(const Rod& rod, const Objective& objective, const State& state) {
  double sum = elastic_energy(rod, state).sum();
  const bool tied = !objective.node_tie.empty();
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    sum -= objective.force[i].dot(state.x[i]);
    if (!tied) continue;
    const Vec3 off = state.x[i] - objective.node_goal[i];
    sum += 0.5 * off.dot(objective.node_tie[i] * off);
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    sum -= objective.moment[j] * state.theta[j];
    if (tied) {
      const double off = state.theta[j] - objective.edge_goal[j];
      sum += 0.5 * objective.edge_tie[j] * off * off;
    }
    sum += barrier_energy(rod, objective.solids, state, j, nullptr);
  }
  return sum;
}

void assemble(const Rod& rod, const Objective& objective, const State& state, const Unknowns& u, System& system) {
  system.hessian.reset(u.count, u.bandwidth);
  system.gradient.assign(static_cast<std::size_t>(u.count), 0.0);
  add_stretching(rod, state, u, system);
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const HingeTerms t = hinge_terms(rod, state, i);
    add_term<11>(u, hinge_coordinates(rod, i), t.gradient, t.hessian, system);
  }
  add_ties(rod, objective, state, u, system);
  if (!objective.solids.solids.empty()) add_barrier(rod, objective, state, u, system);
}

Report minimise(const Rod& rod, const Options& options, State& state, Workspace& work) {
  Report report;
  State at = state;
  find_metric(rod, work.unknowns, work.metric);
  if (!follow_supports(rod, options.predict, at, work, report)) {
    report.outcome = Outcome::blocked;
    return report;
  }
  double now = value(rod, work.objective, at), shift = 0;
  if (!std::isfinite(now)) {
    report.outcome = Outcome::blocked;
    return report;
  }
  while (report.iterations < options.max_iterations) {
    ++report.iterations;
    assemble(rod, work.objective, at, work.unknowns, work.system);
    report.gradient = norm(work.system.gradient);
    if (!factor_shifted(rod, work, shift, report)) break;
    work.step.resize(work.system.gradient.size());
    for (std::size_t k = 0; k < work.step.size(); ++k) work.step[k] = -work.system.gradient[k];
    math::solve(work.factors, work.step);
    expand(work.unknowns, work.step, 0, work.increment);
    const Size size = size_of(rod, work.increment);
    report.last_step = size.step;
    if (size.step <= options.tolerance) {
      const double length = rod.length;
      const double neutral = 1.1 * kLeastShift * rod.stiffness.soft / (length * length * length * length);
      if (shift <= neutral || !options.leave_saddles) {
        move(rod, at, work.increment, 1, work.trial);
        if (std::isfinite(value(rod, work.objective, work.trial))) take_shape(at, work.trial);
        take_shape(state, at);
        report.outcome = Outcome::converged;
        return report;
      }
      if (report.kicks++ == kMostKicks || !kick(rod, shift, now, at, work, now)) break;
      continue;
    }
    if (!search(rod, size.share, now, at, work, now)) {
      report.outcome = Outcome::line_search_failed;
      return report;
    }
  }
  return report;
}

}  // namespace wunderlich::baseline::rod
