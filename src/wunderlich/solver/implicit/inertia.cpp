#include "wunderlich/solver/implicit/inertia.hpp"

#include "wunderlich/energy/torsional_inertia.hpp"

namespace wunderlich::solver::implicit {

using geometry::Ribbon;

namespace {

/// Mass moments of segment s in the coordinates (1, s, t) of its plane, s along the centerline from its middle, t
/// across: those of the trapezoid between the rulings of slopes eta[s] and eta[s + 1]. In the order middle, d3, d2.
Mat3 facet_moments(const Ribbon& ribbon, KineticEnergy kinetic, const std::vector<double>& eta, std::size_t s) {
  const double l = ribbon.rest_length[s], w = ribbon.width, across = ribbon.area_density * w * w * w / 12;
  Mat3 m = Mat3::Zero();
  m(2, 2) = across * l;
  if (kinetic != KineticEnergy::full) return m;
  const double a = eta[s], b = eta[s + 1];
  m(0, 0) = ribbon.area_density * w * l;
  m(1, 1) = ribbon.area_density * w * l * l * l / 12 + across * 0.5 * l * (a * a + b * b);
  m(0, 1) = m(1, 0) = 0.5 * across * (b * b - a * a);
  m(0, 2) = m(2, 0) = across * (b - a);
  m(1, 2) = m(2, 1) = 0.5 * across * l * (a + b);
  return m;
}

/// Middle, d3 and d2 of segment s from the points, as columns: they are linear in them.
Mat3 facet_at(const Ribbon& ribbon, const std::vector<Vec3>& points, std::size_t s) {
  const Vec3 &a = points[s], &b = points[s + 1];
  Mat3 facet;
  facet << 0.5 * (a + b), (b - a) / ribbon.rest_length[s], points[static_cast<std::size_t>(ribbon.segments) + 1 + s];
  return facet;
}

}  // namespace

std::size_t point_count(const Ribbon& ribbon, KineticEnergy kinetic) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  return kinetic == KineticEnergy::centerline ? n + 1 : 2 * n + 1;
}

void read_points(const Ribbon& ribbon, KineticEnergy kinetic, const geometry::Kinematics& k, std::vector<Vec3>& x) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  x.resize(point_count(ribbon, kinetic));
  for (std::size_t i = 0; i <= n; ++i) x[i] = k.r[i];
  if (kinetic == KineticEnergy::centerline) return;
  for (std::size_t s = 0; s < n; ++s) x[n + 1 + s] = k.frame[s].col(1);
}

void tie(const Ribbon& ribbon, KineticEnergy kinetic, const Scheme& scheme, const Points& points,
         const std::vector<double>& eta, ChainProblem& problem) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  problem.tie.resize(n + 1);
  problem.anchor.resize(n + 1);
  const bool rotary = kinetic == KineticEnergy::rotary;
  problem.turn_tie.resize(rotary ? n : 0);
  problem.turn_anchor.resize(problem.turn_tie.size());
  problem.facets.resize(kinetic == KineticEnergy::full ? n : 0);
  for (std::size_t i = 0; i <= n; ++i) {
    problem.tie[i] = kinetic == KineticEnergy::full ? 0 : scheme.stiffness * ribbon.node_mass[i];
    problem.anchor[i] = anchor(scheme, points, i);
  }
  for (std::size_t s = 0; s < problem.turn_tie.size(); ++s) {
    problem.turn_tie[s] = scheme.stiffness * energy::turn_inertia(ribbon, s);
    problem.turn_anchor[s] = anchor(scheme, points, n + 1 + s);
  }
  for (std::size_t s = 0; s < problem.facets.size(); ++s) {
    FacetTie& facet = problem.facets[s];
    facet.weight = scheme.stiffness * facet_moments(ribbon, kinetic, eta, s);
    facet.anchor << 0.5 * (problem.anchor[s] + problem.anchor[s + 1]),
        (problem.anchor[s + 1] - problem.anchor[s]) / ribbon.rest_length[s], anchor(scheme, points, n + 1 + s);
  }
}

double kinetic_energy(const Ribbon& ribbon, KineticEnergy kinetic, const Points& points,
                      const std::vector<double>& eta) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  double twice = 0;
  for (std::size_t i = 0; i <= n && kinetic != KineticEnergy::full; ++i) {
    twice += ribbon.node_mass[i] * points.v[i].squaredNorm();
  }
  for (std::size_t s = 0; s < n && kinetic == KineticEnergy::rotary; ++s) {
    twice += energy::turn_inertia(ribbon, s) * points.v[n + 1 + s].squaredNorm();
  }
  for (std::size_t s = 0; s < n && kinetic == KineticEnergy::full; ++s) {
    const Mat3 v = facet_at(ribbon, points.v, s);
    twice += (facet_moments(ribbon, kinetic, eta, s) * v.transpose() * v).trace();
  }
  return 0.5 * twice;
}

Momentum momentum(const Ribbon& ribbon, KineticEnergy kinetic, const Points& points, const std::vector<double>& eta) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  Momentum total;
  for (std::size_t i = 0; i <= n && kinetic != KineticEnergy::full; ++i) {
    total.linear += ribbon.node_mass[i] * points.v[i];
    total.angular += ribbon.node_mass[i] * points.x[i].cross(points.v[i]);
  }
  for (std::size_t s = 0; s < n && kinetic != KineticEnergy::centerline; ++s) {
    const Mat3 m = facet_moments(ribbon, kinetic, eta, s), x = facet_at(ribbon, points.x, s);
    const Mat3 impulse = facet_at(ribbon, points.v, s) * m;
    if (kinetic == KineticEnergy::full) total.linear += impulse.col(0);
    for (int k = 0; k < 3; ++k) total.angular += x.col(k).cross(impulse.col(k));
  }
  return total;
}

}  // namespace wunderlich::solver::implicit
