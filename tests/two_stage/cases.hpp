/// Ribbons in motion that the tests of the two-stage method share, and the set-up of stage opt outside a step.
#pragma once

#include "wunderlich/solver/two_stage/two_stage.hpp"

namespace wunderlich::testing {

namespace two_stage = solver::two_stage;

/// A ribbon with its drive, options and state.
struct Case {
  geometry::Ribbon ribbon;
  two_stage::Drive drive;
  two_stage::Options options;
  two_stage::State state;
  two_stage::Workspace work;
};

/// A sheet-like cantilever: length 0.3, width 0.03, D = 2.7e-4, rho = 0.1, clamped along +x at its start, let go from
/// straight under 9.81 tilted by `tilt` [rad] out of its plane of bending.
Case cantilever(int segments, double tilt);

/// The same strip without supports and gravity.
Case floating(int segments);

/// A loop of length 2 pi and width 0.4 at its equilibrium, from the equilibrium solver; it feels itself where the
/// surroundings say so.
Case loop(int segments, int half_twists, const constraint::Surroundings& surroundings = {});

/// Velocities that bend and turn a strip.
void disturb(double speed, Case& c);

/// Steps until `duration` is over; the last report. Expects every step to be accepted.
two_stage::StepReport run(double dt, int steps, Case& c);

/// Tables of the workspace for a state that is not in the middle of a step: nothing held but what the ribbon says.
void prepare(const two_stage::Options& options, const geometry::Ribbon& ribbon, const two_stage::Drive& drive,
             const geometry::State& shape, two_stage::Workspace& work);

/// The same bits, not only the same numbers.
bool same_bits(const two_stage::State& a, const two_stage::State& b);

}  // namespace wunderlich::testing
