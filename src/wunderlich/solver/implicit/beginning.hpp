/// The beginning of a step: what is minimised in it, and where from. Internal to solver/implicit/.
#pragma once

#include "wunderlich/solver/implicit/implicit.hpp"

namespace wunderlich::solver::implicit {

/// Supports, loads and inertia of a step that ends at t1; trials get their prescribed bases.
void set_problems(Paths paths, const Options& options, const Scheme& scheme, double t1, const State& state,
                  Workspace& work);

/// What the strips feel where the step begins.
void find_contacts(Paths paths, const State& state, Workspace& work);

/// The problem of a step, and the predictions that Newton's method starts from.
void prepare(Paths paths, const Options& options, const Scheme& scheme, double t1, const State& state, Workspace& work);

/// Where Newton's method may start: the predictions if nothing is in their way, or else where the strips are, or where
/// a moving solid would carry them. False if something is in the way of all these. Says what rubs as well.
bool start_clear(Paths paths, const State& state, double h, Workspace& work);

/// The strips as Newton's method takes them: valid while path and workspace stay where they are.
std::span<const MovingStrip> moving(Paths paths, Workspace& work);

}  // namespace wunderlich::solver::implicit
