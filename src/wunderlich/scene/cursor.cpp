#include "wunderlich/scene/cursor.hpp"

#include <cmath>

#include "wunderlich/base/error.hpp"

namespace wunderlich::scene {

using solver::PathState;

namespace {

/// Calls `visit` on each number whose count is known from the path; the one description of the layout.
template <class State, class Visit>
void visit_state(State& state, const Visit& visit) {
  const auto pose = [&](auto& p) {
    for (int c = 0; c < 3; ++c) visit(p.position[c]);
    visit(p.frame.x()), visit(p.frame.y()), visit(p.frame.z()), visit(p.frame.w());
  };
  visit(state.t), visit(state.dt), visit(state.clock), visit(state.nearest);
  pose(state.chain.base);
  for (auto& kappa : state.chain.kappa) visit(kappa);
  for (auto& eta : state.chain.eta) visit(eta);
  for (auto& multiplier : state.multipliers) visit(multiplier);
  for (auto& origin : state.origin) pose(origin);
  for (auto& q : state.transported) visit(q.x()), visit(q.y()), visit(q.z()), visit(q.w());
}

constexpr std::size_t kCounts = 9;

}  // namespace

std::vector<double> pack_cursor(const PathState& state) {
  std::vector<double> cursor{static_cast<double>(state.phase),
                             static_cast<double>(state.steps),
                             static_cast<double>(state.iterations),
                             static_cast<double>(state.negative_modes),
                             state.closed ? 1.0 : 0.0,
                             static_cast<double>(state.multipliers.size()),
                             static_cast<double>(state.origin.size()),
                             static_cast<double>(state.transported.size()),
                             static_cast<double>(state.touching)};
  visit_state(state, [&](const double& number) { cursor.push_back(number); });
  return cursor;
}

PathState unpack_cursor(const solver::PathProblem& path, const std::vector<double>& cursor) {
  const auto broken = [] { throw InputError("checkpoint: the stored solver state does not fit the stored scene"); };
  if (cursor.size() < kCounts) broken();
  for (std::size_t i = 0; i < kCounts; ++i) {
    if (!(cursor[i] >= 0 && cursor[i] < 1e9 && std::floor(cursor[i]) == cursor[i])) broken();
  }
  if (cursor[0] > static_cast<double>(solver::Phase::done) || cursor[5] > 1e5) broken();
  PathState state;
  state.phase = static_cast<solver::Phase>(static_cast<int>(cursor[0]));
  state.steps = static_cast<int>(cursor[1]);
  state.iterations = static_cast<int>(cursor[2]);
  state.negative_modes = static_cast<int>(cursor[3]);
  state.closed = cursor[4] != 0;
  state.touching = static_cast<int>(cursor[8]);
  const auto count = static_cast<std::size_t>(path.ribbon.node_count());
  const std::size_t supports = path.surroundings.supports.size();
  if (cursor[6] != 0 && cursor[6] != static_cast<double>(supports)) broken();
  if (cursor[7] != static_cast<double>(supports)) broken();
  state.chain.kappa.resize(count);
  state.chain.eta.resize(count);
  state.multipliers.resize(static_cast<std::size_t>(cursor[5]));
  state.origin.resize(static_cast<std::size_t>(cursor[6]));
  state.transported.resize(supports);
  std::size_t size = kCounts;
  visit_state(state, [&](double&) { ++size; });
  if (cursor.size() != size) broken();
  std::size_t next = kCounts;
  visit_state(state, [&](double& number) { number = cursor[next++]; });
  return state;
}

}  // namespace wunderlich::scene
