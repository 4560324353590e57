#include "wunderlich/baseline/shell/balance.hpp"

#include <algorithm>

namespace wunderlich::baseline::shell {

namespace {

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
  Points force = -(shell.bending * state.x);
  add_loads(shell, surroundings, state.x, state.time, force);
  // Both moves put lengths right; what forces add to that is an acceleration.
  Points pushed = state.x, plain = state.x;
  const Points none = Points::Zero(force.rows(), 3);
  if (!move_implicitly(system, shell, hold, force, pushed) || !move_implicitly(system, shell, hold, none, plain))
    return std::nullopt;
  double largest = 0;
  for (int p = 0; p < shell.point_count(); ++p)
    largest = std::max(largest, shell.mass[static_cast<std::size_t>(p)] * (pushed.row(p) - plain.row(p)).norm());
  return largest;
}

}  // namespace wunderlich::baseline::shell
