/// What the steps of a path share: phases, one minimisation, and the account of a failure. Internal to solver/.
#pragma once

#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::solver {

/// Begins a phase: its parameter at 0, and the strip's own poses at the supports noted.
void enter(const PathProblem& path, Phase phase, PathState& state);
Phase next_phase(const PathProblem& path, Phase phase);

/// Remembers the frames that about-tangent constraints are carried on from.
void note_frames(const PathProblem& path, PathState& state);

/// A failed step: says why, and halves the next one unless it is too short already.
void shorten(PathState& state, double planned, PathStep& step);
std::string why(const NewtonReport& report, const PathState& state);

/// Those of a path's options.
NewtonOptions newton_options(const PathProblem& path);

/// Is no hinge folded by more than `tolerance` over the strip's length?
bool is_flat(const geometry::Chain& chain, double length, double tolerance);

/// A flat strip between two held places can leave the plane either way, and its rulings are undetermined: a small
/// bow and slope decide both.
void seed(const geometry::Ribbon& ribbon, geometry::Chain& chain);

/// Fictitious mass of a proximal step, in units of D w / l^4 per length; no passes: a static minimum.
struct Proximal {
  int passes = 0;
  double mass = 0;
};

/// One minimisation from the state's chain at parameter t; chain and multipliers change only on success.
bool solve_at(const PathProblem& path, PathState& state, double t, const Proximal& proximal, NewtonWorkspace& work,
              PathStep& step);

/// The phases that make a loop of the flat strip.
PathStep bend_step(const PathProblem& path, PathState& state);
PathStep twist_step(const PathProblem& path, PathState& state, NewtonWorkspace& work);
PathStep close_step(const PathProblem& path, PathState& state, NewtonWorkspace& work);
PathStep relax_step(const PathProblem& path, PathState& state, NewtonWorkspace& work);

}  // namespace wunderlich::solver
