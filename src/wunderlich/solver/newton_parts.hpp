/// What both of Newton's methods do with one strip: of statics, and of a step in time. Internal to solver/.
#pragma once

#include "wunderlich/solver/newton.hpp"

namespace wunderlich::solver {

constexpr double kSmallestShift = 1e-9, kShiftFactor = 5;

/// Objective + new multipliers * rows + emphasis penalty/2 * rows^2: the Newton step is a descent direction of it.
double merit_of(const NewtonWorkspace& work, const ObjectiveValue& value, const std::vector<double>& residuals,
                double emphasis);

/// Its slope along the step.
double slope_of(const NewtonWorkspace& work, double emphasis);

/// Sum of penalty * rows^2.
double infeasibility_of(const NewtonWorkspace& work);

/// As much penalty as makes the step a descent: the Hessian on the constraints is positive, but under strong reactions
/// the one with the system's penalties need not be. At least half of what the rows lose must show. @eq Nocedal2006:18.5
/// `slope`: with an emphasis of 1.
double emphasis_of(double infeasibility, double slope);

/// Square of the angle by which the step turns the joint at a node.
double turn_squared(const NewtonWorkspace& work, std::size_t node);

/// Largest fold-angle change, displacement / length, and (scaled: it is soft where kappa vanishes) eta change; all go
/// into the report if they are larger than what is there. Returns the largest fold-angle change alone.
double measure_step(const geometry::Ribbon& ribbon, const NewtonWorkspace& work, NewtonReport& report);

/// Shortens the step to keep |x| < 1 and fold angles from jumping.
double step_limit(const geometry::Ribbon& ribbon, const NewtonOptions& options, const geometry::Chain& chain,
                  const NewtonWorkspace& work, double largest_turn);

/// The chain moved by a step times `scale`.
void apply_step(const geometry::Chain& chain, const math::ChainStep& step, double scale, geometry::Chain& trial);

/// NaN if any value is: it must not pass for small.
double max_abs(const std::vector<double>& values);

/// What a shift of 1 means: the bending energy of a segment in kappa, and D l/w in eta.
Vec2 shift_units(const geometry::Ribbon& ribbon);

/// The base too: a strip that hangs on one pin may turn about the vertical freely.
void set_shift(const geometry::Ribbon& ribbon, double shift, math::ChainSystem& system);

}  // namespace wunderlich::solver
