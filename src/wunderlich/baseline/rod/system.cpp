#include "wunderlich/baseline/rod/system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wunderlich::baseline::rod {

namespace {

constexpr double kLargestBend = 0.8;  // change of an edge in one iteration, over its rest length
constexpr double kLargestTurn = 1;    // of a section [rad]

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

void add_stretching(const Rod& rod, const State& state, const Unknowns& u, std::span<const double> stress,
                    System& system) {
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const EdgeTerms t = edge_terms(rod, state, j, stress.empty() ? tension(rod, state, j) : stress[j]);
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
  for (std::size_t j = 0; tied && j < rod.edges(); ++j) {
    const double tie = objective.edge_tie[j], slope = tie * (state.theta[j] - objective.edge_goal[j]);
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

/// Loads without a potential, on the seven coordinates of their edges.
void add_followers(const Objective& objective, const State& state, const Unknowns& u, System& system) {
  system.follower.clear();
  for (const Follower& load : objective.followers) {
    const FollowerTerms t = follower_terms(state, load);
    for (int k = 0; k < 7; ++k) {
      const int row = u.number[4 * load.edge + static_cast<std::size_t>(k)];
      if (row < 0) continue;
      double slope = -t.force[k];
      for (int c = 0; c < 7; ++c) {
        const std::size_t coordinate = 4 * load.edge + static_cast<std::size_t>(c);
        slope -= t.derivative(k, c) * u.given[coordinate];
        if (u.number[coordinate] >= 0) system.follower.push_back({row, u.number[coordinate], -t.derivative(k, c)});
      }
      system.gradient[static_cast<std::size_t>(row)] += slope;
    }
  }
}

}  // namespace

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
    if (tied) {
      const double off = state.theta[j] - objective.edge_goal[j];
      sum += 0.5 * objective.edge_tie[j] * off * off;
    }
    sum += barrier_energy(rod, objective.solids, state, j, nullptr);
  }
  return sum;
}

void assemble(const Rod& rod, const Objective& objective, const State& state, const Unknowns& u, System& system,
              std::span<const double> stress) {
  system.hessian.reset(u.count, u.bandwidth);
  system.gradient.assign(static_cast<std::size_t>(u.count), 0.0);
  add_stretching(rod, state, u, stress, system);
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const HingeTerms t = hinge_terms(rod, state, i, stress.empty() ? nullptr : &stress[rod.edges() + 5 * i]);
    add_term<11>(u, hinge_coordinates(rod, i), t.gradient, t.hessian, system);
  }
  add_ties(rod, objective, state, u, system);
  if (!objective.solids.solids.empty()) add_barrier(rod, objective, state, u, system);
  add_followers(objective, state, u, system);
}

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

void expand(const Unknowns& u, const std::vector<double>& step, double given, std::vector<double>& increment) {
  increment.resize(u.number.size());
  for (std::size_t c = 0; c < u.number.size(); ++c) {
    increment[c] = given * u.given[c] + (u.number[c] >= 0 ? step[static_cast<std::size_t>(u.number[c])] : 0.0);
  }
}

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

void swap_shapes(State& a, State& b) {
  std::swap(a.x, b.x);
  std::swap(a.theta, b.theta);
  std::swap(a.reference, b.reference);
  std::swap(a.reference_twist, b.reference_twist);
}

}  // namespace wunderlich::baseline::rod
