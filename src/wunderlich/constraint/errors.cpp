#include "wunderlich/constraint/errors.hpp"

#include <cmath>

namespace wunderlich::constraint {

namespace {

/// Keeps the larger, and a NaN once there is one: an error that is no number must not pass for 0.
void raise(double& largest, double value) {
  if (std::isnan(largest)) return;
  if (!(std::abs(value) <= largest)) largest = std::abs(value);
}

}  // namespace

ConstraintErrors errors(const geometry::Ribbon& ribbon, const geometry::State& state) {
  ConstraintErrors out;
  const geometry::Strains strain = strains(ribbon, state);
  const auto segments = static_cast<std::size_t>(ribbon.segments);
  for (std::size_t s = 0; s < segments; ++s) {
    const Vec3 edge = state.r[s + 1] - state.r[s];
    const double length = edge.norm();
    const double parallel = (edge / length - state.q[s] * Vec3::UnitZ()).norm();
    raise(out.max_length_error, length / ribbon.rest_length[s] - 1);
    raise(out.max_parallel_error, parallel);
    raise(out.max_ruling_ratio, strain.ruling_ratio[s]);
  }
  for (std::size_t i = 0; i <= segments; ++i) {
    const double h = ribbon.hinge_length[i];
    raise(out.max_binormal, h * strain.gamma[i]);
    raise(out.max_torsion_mismatch, h * (strain.kappa[i] * state.eta[i] - strain.tau[i]));
  }
  return out;
}

}  // namespace wunderlich::constraint
