/// Implicit dynamics: one minimisation a step on the exactly isometric chain of trapezoids. Every internal constraint
/// holds at every step by construction; no step is too long to be stable.
///
/// The elastic energy, barrier, loads and supports are those of the equilibrium solver (`PathProblem`, its parameter is
/// the time); inertia ties the strip to where it was going.   @eq Shen2015:6 @eq Martin2011
#pragma once

#include "wunderlich/solver/implicit/conserve.hpp"
#include "wunderlich/solver/implicit/types.hpp"

namespace wunderlich::solver::implicit {

struct Workspace {
  NewtonWorkspace newton;
  ChainProblem problem;
  geometry::Chain trial, start;
  std::vector<double> multipliers, residuals;
  std::vector<Vec3> x;
  ContactProblem solids;  ///< where they are at the start of a step
  Touching before;        ///< what the strip touches there
  Points points;
  ConserveWorkspace conserve;
  geometry::Kinematics kinematics;
};

/// A motion from `shape` on (positions, frames, rulings, velocities of the nodes); facets turn with `spin` [rad/s].
/// The strip must satisfy its constraints.
State start(const PathProblem& path, const Options& options, const geometry::State& shape, const Vec3& spin,
            Workspace& work);

/// Finds the accelerations anew: after the supports have changed.
void find_accelerations(const PathProblem& path, const Options& options, State& state, Workspace& work);

/// The same motion on a strip that is held otherwise (a clamp has let go): joint coordinates anew, velocities kept.
void change_supports(const PathProblem& before, const PathProblem& after, State& state);

/// One step from `state.path.t` to t1; a step that fails leaves the state as it was and says why. `halvings`: how often
/// the step that was asked for has been halved because it failed; from two on an impulse may be taken up as one.
StepReport step(const PathProblem& path, const Options& options, double t1, int halvings, State& state,
                Workspace& work);

/// The paper's coordinates, with the nodes' velocities.
geometry::State shape_of(const PathProblem& path, const State& state);

}  // namespace wunderlich::solver::implicit
