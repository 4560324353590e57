#include "wunderlich/baseline/shell/balance.hpp"

namespace wunderlich::baseline::shell {

namespace {

constexpr int kMostPasses = 200;
constexpr double kTaken = 1e-3;  // of what is left, in a pass: no more is to come

std::array<Sparse, 3> mass_matrices(const Hold& hold) {
  std::array<Sparse, 3> out;
  for (std::size_t a = 0; a < 3; ++a) {
    out[a].resize(hold.unknown_count[a], hold.unknown_count[a]);
    out[a].setIdentity();
    for (int k = 0; k < hold.unknown_count[a]; ++k) out[a].coeffRef(k, k) = hold.mass[a][static_cast<std::size_t>(k)];
  }
  return out;
}

}  // namespace

std::optional<double> net_force(const Shell& shell, const constraint::Surroundings& surroundings, const State& state) {
  const Hold hold = make_hold(shell, surroundings, state.time);
  ImplicitSystem system = make_implicit_system(shell, hold, mass_matrices(hold));
  const Eigen::Map<const Eigen::VectorXd> mass(shell.mass.data(), shell.point_count());
  Points plain = state.x;  // where putting lengths right alone moves it
  if (!factor_at(system, hold, state.x)) return std::nullopt;
  move_as_factored(system, shell, hold, Points::Zero(shell.point_count(), 3), plain);
  Points force = -(shell.bending * state.x);
  add_loads(shell, surroundings, state.x, state.time, force);
  // The system's rows give a little, and take a share only of what they could where the shell is nearly flat.
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Points pushed = state.x;
    move_as_factored(system, shell, hold, force, pushed);
    const Points left = mass.asDiagonal() * (pushed - plain);
    const double taken = (force - left).norm();
    force = left;
    if (taken <= kTaken * left.norm()) break;
  }
  return force.rowwise().norm().maxCoeff();
}

}  // namespace wunderlich::baseline::shell
