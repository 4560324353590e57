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
Vec6 twist_of(const Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta, const Points& points,
              const Momentum& wanted) {
  Points unit = points;
  math::Mat6 inertia;
  for (Eigen::Index c = 0; c < 6; ++c) {
    const Vec6 twist = Vec6::Unit(c);
    for (std::size_t i = 0; i < points.x.size(); ++i) unit.v[i] = rigid(twist, ribbon, points, i);
    inertia.col(c) = joined(momentum(ribbon, kinetic, unit, eta));
  }
  return inertia.completeOrthogonalDecomposition().solve(joined(wanted));
}

}  // namespace

double conserve(const Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta, const Conserved& wanted,
                Points& points) {
  std::vector<Vec3> whole(points.x.size(), Vec3::Zero());  // the part of the velocity that momenta decide
  double of_whole = 0;
  if (wanted.momentum != nullptr) {
    const Vec6 now = twist_of(ribbon, kinetic, eta, points, momentum(ribbon, kinetic, points, eta));
    const Vec6 goal = twist_of(ribbon, kinetic, eta, points, *wanted.momentum);
    Points rigid_motion = points;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      whole[i] = rigid_motion.v[i] = rigid(goal, ribbon, points, i);
      points.v[i] += whole[i] - rigid(now, ribbon, points, i);
    }
    of_whole = kinetic_energy(ribbon, kinetic, rigid_motion, eta);
  }
  // Rigid motion and the rest are orthogonal in the kinetic energy.
  const double rest = kinetic_energy(ribbon, kinetic, points, eta) - of_whole;
  if (!(rest > 0)) return wanted.kinetic - of_whole;
  const double exact = std::sqrt(std::max(0.0, (wanted.kinetic - of_whole) / rest));
  const double factor = std::clamp(exact, 1 - kLargestChange, 1 + kLargestChange);
  for (std::size_t i = 0; i < points.v.size(); ++i) points.v[i] = whole[i] + factor * (points.v[i] - whole[i]);
  return wanted.kinetic - of_whole - factor * factor * rest;
}

}  // namespace wunderlich::solver::implicit
