// What is inert in a strip: kinetic energies against integrals over the facets, momenta as their derivatives.
#include "wunderlich/solver/implicit/inertia.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "implicit/motions.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using implicit::KineticEnergy;
using implicit::Points;

constexpr KineticEnergy kAll[] = {KineticEnergy::centerline, KineticEnergy::rotary, KineticEnergy::full};

/// A bent and twisted strip with uneven segments, and what moves it.
struct Moving {
  Ribbon ribbon;
  Chain chain, ahead, behind;
  double span = 1e-4;  ///< [s] between behind and ahead

  explicit Moving(unsigned seed) {
    geometry::RibbonSpec spec = sheet(1, false);
    spec.segments = 5;
    spec.width = 0.05;
    spec.spacing = {1, 1.3, 0.7, 1, 1.2};
    ribbon = geometry::make_ribbon(spec);
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    chain = geometry::straight_chain(ribbon, {Vec3(0.1, -0.2, 0.3), math::exp_map(Vec3(0.3, 1, -0.4))});
    for (std::size_t i = 1; i < 5; ++i) {
      chain.kappa[i] = 5 * normal(engine);
      chain.eta[i] = 0.3 * normal(engine);
    }
    ahead = behind = chain;
    const auto shift = [&](Chain& c, double t) {
      c.base.position += t * Vec3(1, -2, 0.5);
      c.base.frame = math::exp_map(t * Vec3(3, 1, -2)) * c.base.frame;
      for (std::size_t i = 1; i < 5; ++i) c.kappa[i] += t * 40 * std::cos(static_cast<double>(i));
    };
    shift(ahead, 0.5 * span), shift(behind, -0.5 * span);
  }

  /// Velocities as differences of positions.
  Points points(KineticEnergy kinetic) const {
    Points p;
    implicit::resize(implicit::point_count(ribbon, kinetic), p);
    std::vector<Vec3> x0, x1;
    Kinematics k;
    geometry::forward_kinematics(ribbon, behind, k);
    implicit::read_points(ribbon, kinetic, k, x0);
    geometry::forward_kinematics(ribbon, ahead, k);
    implicit::read_points(ribbon, kinetic, k, x1);
    geometry::forward_kinematics(ribbon, chain, k);
    implicit::read_points(ribbon, kinetic, k, p.x);
    for (std::size_t i = 0; i < x0.size(); ++i) p.v[i] = (x1[i] - x0[i]) / span;
    return p;
  }
};

/// Where the material point of a facet is: `along` its tangent and `across` from the middle of its centerline.
Vec3 material_point(const Kinematics& k, std::size_t s, double along, double across) {
  return 0.5 * (k.r[s] + k.r[s + 1]) + along * k.frame[s].col(2) + across * k.frame[s].col(1);
}

/// Half the integral of rho |v|^2 over the facets, by Gauss points between their rulings.   @eq Shen2015:5
double by_quadrature(const Moving& m) {
  Kinematics k0, k1;
  geometry::forward_kinematics(m.ribbon, m.behind, k0);
  geometry::forward_kinematics(m.ribbon, m.ahead, k1);
  const double node[] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, weight[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  double twice = 0;
  for (std::size_t s = 0; s < 5; ++s) {
    for (int i = 0; i < 3; ++i) {
      const double t = 0.5 * m.ribbon.width * node[i], l = m.ribbon.rest_length[s];
      const double from = -0.5 * l + m.chain.eta[s] * t, to = 0.5 * l + m.chain.eta[s + 1] * t;
      for (int j = 0; j < 3; ++j) {
        const double at = 0.5 * (from + to) + 0.5 * (to - from) * node[j];
        const Vec3 v = (material_point(k1, s, at, t) - material_point(k0, s, at, t)) / m.span;
        twice += 0.25 * weight[i] * weight[j] * m.ribbon.width * (to - from) * v.squaredNorm();
      }
    }
  }
  return 0.5 * m.ribbon.area_density * twice;
}

TEST(Inertia, OfTheWholeStripIsTheIntegralOverItsFacets) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Moving m(seed);
    const double sum = by_quadrature(m);
    const double full =
        implicit::kinetic_energy(m.ribbon, KineticEnergy::full, m.points(KineticEnergy::full), m.chain.eta);
    EXPECT_NEAR(full, sum, 1e-11 * sum);
    // The others leave something out.
    const auto rotary = m.points(KineticEnergy::rotary);
    EXPECT_GT(std::abs(implicit::kinetic_energy(m.ribbon, KineticEnergy::rotary, rotary, m.chain.eta) - sum),
              1e-3 * sum);
  }
}

TEST(Inertia, MomentumIsTheDerivativeOfTheKineticEnergy) {
  const Moving m(1);
  const std::size_t nodes = static_cast<std::size_t>(m.ribbon.node_count());
  for (const KineticEnergy kinetic : kAll) {
    const Points p = m.points(kinetic);
    const implicit::Momentum momentum = implicit::momentum(m.ribbon, kinetic, p, m.chain.eta);
    // The energy is quadratic: its central difference is exact.
    const auto difference = [&](const Vec3& push, const Vec3& spin) {
      double side[2];
      for (int sign : {-1, 1}) {
        Points moved = p;
        for (std::size_t i = 0; i < p.x.size(); ++i) moved.v[i] += sign * spin.cross(p.x[i]);
        for (std::size_t i = 0; i < nodes; ++i) moved.v[i] += sign * push;
        side[(sign + 1) / 2] = implicit::kinetic_energy(m.ribbon, kinetic, moved, m.chain.eta);
      }
      return 0.5 * (side[1] - side[0]);
    };
    const double scale = momentum.linear.norm() + momentum.angular.norm();
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(momentum.linear[c], difference(Vec3::Unit(c), Vec3::Zero()), 1e-10 * scale);
      EXPECT_NEAR(momentum.angular[c], difference(Vec3::Zero(), Vec3::Unit(c)), 1e-10 * scale);
    }
    EXPECT_GT(momentum.linear.norm(), 1e-4);
    EXPECT_GT(momentum.angular.norm(), 1e-5);
  }
}

/// A plate that turns about its middle: m (w^2, l^2, l^2 + w^2)/12 about its length, width and normal.
TEST(Inertia, OfASpinningPlateIsThePlates) {
  geometry::RibbonSpec spec = sheet(1, false);
  spec.width = 0.1;
  Motion motion = make_motion(spec, {});
  motion.options.kinetic = KineticEnergy::full;
  geometry::State shape = geometry::straight_state(motion.path.ribbon);
  const Vec3 middle(0.5 * spec.length, 0, 0);
  const double mass = spec.area_density * spec.length * spec.width, l = spec.length, w = spec.width;
  const Vec3 moments = mass / 12 * Vec3(w * w, l * l, l * l + w * w);
  for (const Vec3& spin : {Vec3(2, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 4), Vec3(1, -2, 3)}) {
    for (std::size_t i = 0; i < shape.r.size(); ++i) shape.r_dot[i] = spin.cross(shape.r[i] - middle);
    start(shape, spin, motion);
    const double rigid = 0.5 * spin.cwiseProduct(spin).dot(moments);
    EXPECT_NEAR(kinetic(motion), rigid, 1e-12 * rigid);
  }
}

}  // namespace
}  // namespace wunderlich::testing
