/// A time step of either shell: implicit Euler of the bending, then fast projection.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "wunderlich/baseline/shell/fast_projection.hpp"
#include "wunderlich/baseline/shell/hold.hpp"
#include "wunderlich/baseline/shell/shell.hpp"
#include "wunderlich/constraint/support.hpp"

namespace wunderlich::baseline::shell {

struct Options {
  double length_tolerance = 0.01;  ///< on the relative error of a length, and of the gaps of a nonconforming boundary
  int max_iterations = 200;        ///< of fast projection
  double damping = 0;              ///< rate at which velocities decay [1/s]
  bool accept_inexact = false;     ///< accept a step whose lengths did not reach the tolerance
};

/// What moves.
struct State {
  double time = 0;
  Points x;  ///< [m]
  Points v;  ///< [m/s]
};

/// What a step uses again as long as its length and the supports in force stay the same.
struct Work {
  double step = 0;
  Hold hold;
  std::array<std::unique_ptr<Factor>, 3> factor;  ///< of M + h^2 K; empty where another axis has the same
  std::array<std::size_t, 3> factor_of{};
  std::array<Sparse, 3> to_unknowns;  ///< transposed selections
  std::vector<LengthSystem> lengths;
  BoundarySystem boundary;
  Points offset, force, start;
};

struct StepReport {
  bool accepted = false;
  bool converged = false;  ///< lengths and boundary met the tolerance
  std::string failure;     ///< why not; empty if accepted
  int iterations = 0;      ///< rounds of fast projection over all sets of lengths
  int boundary_iterations = 0;
  int touching = 0;             ///< points that a solid pushes
  double max_length_error = 0;  ///< after the step, contact included
  double sol_seconds = 0;       ///< t_sol: the solve of implicit Euler
  double length_seconds = 0;    ///< t_len
  double boundary_seconds = 0;  ///< t_bd
  double other_seconds = 0;     ///< setting up when something changed, contact
};

/// Moves `state` to `t1`; it stays as it is if the step is not accepted.   @eq Shen2015:6.6
StepReport step(const Shell& shell, const constraint::Surroundings& surroundings, const Options& options, double t1,
                State& state, Work& work);

/// At rest, flat, with its start where the clamp of the start stands if there is one; `bulge` [m] lifts it by a half
/// sine out of its plane, so that it can buckle.
State straight_state(const Shell& shell, const constraint::Surroundings& surroundings, double bulge = 0);

}  // namespace wunderlich::baseline::shell
