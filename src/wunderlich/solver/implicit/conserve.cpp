#include "wunderlich/solver/implicit/conserve.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace wunderlich::solver::implicit {

using geometry::Ribbon;

namespace {

constexpr double kLargestChange = 0.25;  // of the velocities' scale in one step

using Vec6 = math::Vec6;

Vec6 joined(const Momentum& p) {
  Vec6 out;
  out << p.linear, p.angular;
  return out;
}

/// Velocity of point i in the rigid motion `twist`: (velocity at the origin, angular velocity). Directions only turn.
Vec3 rigid(const Vec6& twist, const Ribbon& ribbon, const Points& points, std::size_t i) {
  const bool node = i <= static_cast<std::size_t>(ribbon.segments);
  return (node ? Vec3(twist.head<3>()) : Vec3::Zero()) + twist.tail<3>().cross(points.x[i]);
}

/// The rigid motion with the given momenta. A straight strip without inertia about itself has more than one; least.
Vec6 twist_of(const Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta, const Momentum& wanted,
              Points& unit) {
  math::Mat6 inertia;
  for (Eigen::Index c = 0; c < 6; ++c) {
    const Vec6 twist = Vec6::Unit(c);
    for (std::size_t i = 0; i < unit.x.size(); ++i) unit.v[i] = rigid(twist, ribbon, unit, i);
    inertia.col(c) = joined(momentum(ribbon, kinetic, unit, eta));
  }
  return inertia.completeOrthogonalDecomposition().solve(joined(wanted));
}

/// f of the kinetic energy kept + f coupling + f^2 rest that is wanted; 1 where nothing can be scaled.
double scale(double wanted, double kept, double coupling, double rest) {
  if (!(rest > 0)) return 1;
  const double root = coupling * coupling - 4 * rest * (kept - wanted);
  return (std::sqrt(std::max(0.0, root)) - coupling) / (2 * rest);
}

}  // namespace

double conserve(const Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta, const Conserved& wanted,
                ConserveWorkspace& work, Points& points) {
  Points &kept = work.kept, &rest = work.rest;
  kept.x = rest.x = points.x;
  rest.v = points.v;
  kept.v.assign(points.v.size(), Vec3::Zero());
  if (wanted.momentum != nullptr) {
    const Vec6 now = twist_of(ribbon, kinetic, eta, momentum(ribbon, kinetic, points, eta), kept);
    const Vec6 goal = twist_of(ribbon, kinetic, eta, *wanted.momentum, kept);
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      kept.v[i] = rigid(goal, ribbon, points, i);
      rest.v[i] -= rigid(now, ribbon, points, i);
    }
  }
  for (const std::size_t i : work.held) {
    kept.v[i] += rest.v[i];
    rest.v[i].setZero();
  }
  for (std::size_t i = 0; i < points.v.size(); ++i) points.v[i] = kept.v[i] + rest.v[i];
  const double all = kinetic_energy(ribbon, kinetic, points, eta);
  const double of_kept = kinetic_energy(ribbon, kinetic, kept, eta);
  const double of_rest = kinetic_energy(ribbon, kinetic, rest, eta);
  const double coupling = all - of_kept - of_rest;
  const double factor =
      std::clamp(scale(wanted.kinetic, of_kept, coupling, of_rest), 1 - kLargestChange, 1 + kLargestChange);
  for (std::size_t i = 0; i < points.v.size(); ++i) points.v[i] = kept.v[i] + factor * rest.v[i];
  return wanted.kinetic - of_kept - factor * (coupling + factor * of_rest);
}

}  // namespace wunderlich::solver::implicit
