/// Which coordinates of a rod are unknown, and how supports move the others.
#pragma once

#include <vector>

#include "wunderlich/baseline/rod/frames.hpp"
#include "wunderlich/constraint/support.hpp"

namespace wunderlich::baseline::rod {

/// Every coordinate's increment is that of an unknown, if it has one, plus what is given. A clamp holds an edge at its
/// rest length with the turn of its section, as is usual for these rods; where it leaves a world axis free, both nodes
/// of the edge share an unknown. The last node of a loop shares those of the first.
struct Unknowns {
  int count = 0;
  int bandwidth = 0;          ///< of a Hessian in these unknowns
  std::vector<int> number;    ///< (coordinates) of the unknown, -1: none
  std::vector<double> given;  ///< (coordinates) [m, rad]
};

/// Supports at `time`, for a state that satisfied them at `state.time`. Where `anchored`, a rod that nothing holds is
/// kept from moving as a rigid body (equilibria).
void hold(const Rod& rod, const std::vector<constraint::Support>& supports, const State& state, double time,
          bool anchored, Unknowns& unknowns);

/// Do supports move at all, by more than what rounding makes of those that stand?
bool supports_moved(const Unknowns& unknowns);

}  // namespace wunderlich::baseline::rod
