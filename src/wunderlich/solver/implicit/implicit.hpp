/// Implicit dynamics: one minimisation a step on the exactly isometric chain of trapezoids. Every internal constraint
/// holds at every step by construction; no step is too long to be stable.
///
/// The elastic energy, barrier, loads and supports are those of the equilibrium solver (`PathProblem`, its parameter is
/// the time); inertia ties the strip to where it was going.   @eq Shen2015:6 @eq Martin2011
#pragma once

#include <span>

#include "wunderlich/solver/implicit/conserve.hpp"
#include "wunderlich/solver/implicit/minimise.hpp"
#include "wunderlich/solver/implicit/types.hpp"

namespace wunderlich::solver::implicit {

/// The strips of a scene, each with all that surrounds it.
using Paths = std::span<const PathProblem>;

struct StripWorkspace {
  ChainProblem problem;
  geometry::Chain trial, start;
  std::vector<double> multipliers, residuals;
  std::vector<Vec3> x;
  ContactProblem solids;  ///< where they are at the start of a step
  ContactPoints before;   ///< what the strip touches there
  Points points;
  ConserveWorkspace conserve;
  geometry::Kinematics kinematics;
};

struct Workspace {
  std::vector<StripWorkspace> strips;
  SelfContact self;          ///< how strips feel themselves and one another
  SelfContacts self_before;  ///< and what they felt at the start of a step
  MinimiseWorkspace newton;
  std::vector<MovingStrip> moving;
};

/// A motion from these shapes on (positions, frames, rulings, velocities of the nodes); facets turn with `spin`
/// [rad/s]. Strips must satisfy their constraints; one of each for each path.
State start(Paths paths, const Options& options, std::span<const geometry::State> shapes, std::span<const Vec3> spins,
            Workspace& work);

/// Finds the accelerations anew: after the supports have changed.
void find_accelerations(Paths paths, const Options& options, State& state, Workspace& work);

/// The same motion on a strip that is held otherwise (a clamp has let go): joint coordinates anew, velocities kept.
void change_supports(const PathProblem& before, const PathProblem& after, StripState& strip);

/// One step from `state.time()` to t1; a step that fails leaves the state as it was and says why. `halvings`: how often
/// the step that was asked for has been halved because it failed; from two on an impulse may be taken up as one.
StepReport step(Paths paths, const Options& options, double t1, int halvings, State& state, Workspace& work);

/// The paper's coordinates, with the nodes' velocities.
geometry::State shape_of(const PathProblem& path, const StripState& strip);

/// The same for one strip alone.
inline State start(const PathProblem& path, const Options& options, const geometry::State& shape, const Vec3& spin,
                   Workspace& work) {
  return start(Paths(&path, 1), options, {&shape, 1}, {&spin, 1}, work);
}
inline StepReport step(const PathProblem& path, const Options& options, double t1, int halvings, State& state,
                       Workspace& work) {
  return step(Paths(&path, 1), options, t1, halvings, state, work);
}
inline geometry::State shape_of(const PathProblem& path, const State& state) {
  return shape_of(path, state.strips.front());
}

}  // namespace wunderlich::solver::implicit
