/// Strips built by hand for the tests of this folder, independent of the solvers.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::geometry::testing {

/// An exact isometry: planar trapezoids hinged along their rulings. `kappa` and `eta` by node; those of the inner
/// nodes are used. Free ends, in an arbitrary pose.
inline State hinged_chain(const Ribbon& ribbon, const std::vector<double>& kappa, const std::vector<double>& eta) {
  State state = straight_state(ribbon);
  const Quat pose = math::exp_map(Vec3(0.3, -1.1, 0.7));
  state.eta = eta;
  state.r[0] = Vec3(0.2, -0.4, 1.5);
  state.q[0] = pose * state.q[0];
  for (std::size_t s = 0; s < state.q.size(); ++s) {
    if (s > 0) {
      const Vec3 turn(0, kappa[s], kappa[s] * eta[s]);
      state.q[s] = state.q[s - 1] * math::exp_map(ribbon.hinge_length[s] * turn);
    }
    state.r[s + 1] = state.r[s] + ribbon.rest_length[s] * (state.q[s] * Vec3::UnitZ());
  }
  state.end_frame = {state.q.front(), state.q.back()};
  return state;
}

/// Strains of a random chain, |x| <= largest_ratio on every segment and fold angles up to about 0.4 rad.
struct RandomStrains {
  std::vector<double> kappa, eta;
};

inline RandomStrains random_strains(const Ribbon& ribbon, double largest_ratio, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  RandomStrains out;
  out.kappa.resize(static_cast<std::size_t>(ribbon.node_count()));
  out.eta.resize(out.kappa.size());
  for (std::size_t i = 0; i < out.kappa.size(); ++i) {
    out.kappa[i] = 0.4 * uniform(generator) / ribbon.rest_length[0];
    if (i == 0) continue;
    out.eta[i] =
        0.9 * out.eta[i - 1] + largest_ratio * uniform(generator) * 2 * ribbon.rest_length[i - 1] / ribbon.width;
    const double step = out.eta[i] - out.eta[i - 1];
    const double bound = largest_ratio * 2 * ribbon.rest_length[i - 1] / ribbon.width;
    out.eta[i] = out.eta[i - 1] + std::clamp(step, -bound, bound);
  }
  return out;
}

/// A closed polygon of unit total length through a smooth knotted-looking space curve.
inline std::vector<Vec3> closed_curve(int segments, double height) {
  std::vector<Vec3> points;
  double length = 0;
  for (int i = 0; i <= segments; ++i) {
    const double t = 2 * std::numbers::pi * (i % segments) / segments;
    points.emplace_back(std::cos(t) + 0.5 * std::cos(2 * t), std::sin(t) - 0.4 * std::sin(3 * t),
                        height * (std::sin(2 * t) + 0.3 * std::cos(3 * t + 0.2)));
    if (i > 0) length += (points[points.size() - 1] - points[points.size() - 2]).norm();
  }
  for (Vec3& p : points) p /= length;
  return points;
}

/// A loop along a closed polygon: frames carried parallel along it, plus the uniform turn about d3 that closes
/// them across the seam, plus `whole_turns`. Not an isometry.
inline State closed_strip(const Ribbon& ribbon, const std::vector<Vec3>& points, int whole_turns) {
  State state = straight_state(ribbon);
  state.r = points;
  const std::size_t n = state.q.size();
  std::vector<Vec3> tangent(n);
  for (std::size_t s = 0; s < n; ++s) tangent[s] = (points[s + 1] - points[s]).normalized();
  std::vector<Quat> carried(n + 1);
  carried[0] = math::shortest_rotation(Vec3::UnitZ(), tangent[0]);
  for (std::size_t s = 1; s <= n; ++s) {
    carried[s] = math::shortest_rotation(tangent[s - 1], tangent[s % n]) * carried[s - 1];
  }
  const Vec3 missing = math::log_map(carried[n].conjugate() * across_seam(ribbon, carried[0]));
  const double turn = missing.z() + 2 * std::numbers::pi * whole_turns;
  for (std::size_t s = 0; s < n; ++s) {
    state.q[s] = carried[s] * math::exp_map(Vec3(0, 0, turn * static_cast<double>(s) / static_cast<double>(n)));
  }
  return state;
}

}  // namespace wunderlich::geometry::testing
