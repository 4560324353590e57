/// Newton's method of statics, with exact second-order checks, on a chain problem.
#pragma once

#include <vector>

#include "wunderlich/solver/chain_objective.hpp"

namespace wunderlich::solver {

struct NewtonOptions {
  double tolerance = 1e-10;  ///< on the step: fold angles [rad], displacements / length
  int max_iterations = 300;
  double max_turn = 0.6;       ///< largest change of a fold angle in one iteration [rad]
  double largest_shift = 1e6;  ///< of the pivots, over those of bending alone: what needs more counts as singular
};

enum class NewtonOutcome {
  converged,
  iteration_limit,
  line_search_failed,  ///< no step along the direction lowers the merit
  singular,            ///< no shift made the reduced Hessian positive
};

struct NewtonReport {
  NewtonOutcome outcome = NewtonOutcome::iteration_limit;
  int iterations = 0;
  int sweeps = 0;           ///< linear solves; more than iterations where shifts were needed
  int evaluations = 0;      ///< objective evaluations in the line search
  int kicks = 0;            ///< times it left a stationary point that was no minimum
  int flat = 0;             ///< iterations whose decrease was below rounding
  int unshifted = 0;        ///< times a shift was dropped for the last steps
  bool neutral = false;     ///< the softest mode has no stiffness to rounding: one of a family of minima
  int negative_modes = 0;   ///< of the unshifted reduced Hessian where it stopped
  double max_residual = 0;  ///< of the constraint rows (m, rad, 1)
  double last_step = 0;
  int worst_node = 0;    ///< where the last step was largest
  ObjectiveValue value;  ///< at the minimum
  bool converged() const { return outcome == NewtonOutcome::converged; }
};

/// Buffers of the solve on one strip; no allocation once they have their size.
struct NewtonWorkspace {
  math::ChainSystem system;
  math::ChainWorkspace sweep;
  math::ChainStep step;
  geometry::Kinematics kinematics, trial_kinematics;
  geometry::Chain current, trial;
  std::vector<double> multipliers;
  std::vector<double> residuals, trial_residuals;
  ObjectiveValue value, trial_value;
  Touching touching, trial_touching;
  SelfSearch search;
  std::vector<Vec2> load;  ///< right-hand side of the search for the softest mode
};

/// Finds a local minimum of the problem near `chain`, which it updates only if it converges. `multipliers` (one
/// a row; 0 will do to start) are updated with it.
NewtonReport minimise(const geometry::Ribbon& ribbon, const ChainProblem& problem, const NewtonOptions& options,
                      geometry::Chain& chain, std::vector<double>& multipliers, NewtonWorkspace& work);

}  // namespace wunderlich::solver
