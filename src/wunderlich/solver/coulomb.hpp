/// Coulomb's friction of one point during a step, smooth where it hardly slides: force over the way, per force.
/// @eq Li2020:14
#pragma once

namespace wunderlich::solver {

constexpr double kSlipSpeed = 1e-3;  ///< below which friction is less than Coulomb's [m/s]

/// What is minimised for a way, where friction has its full force from a way of `slip` on [m].
inline double sliding_value(double way, double slip) {
  const double share = way / slip;
  return share < 1 ? way * share * (1 - share / 3) : way - slip / 3;
}

/// Force over way, (2 share - share^2) / way; finite at rest.
inline double pull_of(double way, double slip) { return way < slip ? (2 - way / slip) / slip : 1 / way; }

/// Stiffness along the way and across it; the latter is the force over the way.
struct Pull {
  double along, across;
};

/// What will stick has far more stiffness than it shows on the way there. Until that is `settled` the stiffness along
/// is that of a parabola that touches here and lies above everywhere else: it ends within reach of the minimum; the
/// exact one overshoots by what it does not see.
inline Pull pull_of(double way, double slip, bool settled) {
  const double across = pull_of(way, slip);
  if (!settled) return {across, across};
  return {way < slip ? 2 * (1 - way / slip) / slip : 0, across};
}

}  // namespace wunderlich::solver
