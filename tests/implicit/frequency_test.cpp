// Small oscillations against theory: a cantilever in its plane, a ring out of its plane, where the strip twists.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"

namespace wunderlich::testing {
namespace {

using implicit::KineticEnergy;

/// Frequency of sum_i weight_i x_i, from its first to its last zero in `periods` expected periods [Hz].
double frequency(const std::vector<Vec3>& weight, double expected, int periods, double dt, Motion& m) {
  const auto sum = [&](const std::vector<Vec3>& vectors) {
    double total = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) total += weight[i].dot(vectors[i]);
    return total;
  };
  double before = sum(m.state.strips[0].points.x), v_before = sum(m.state.strips[0].points.v);
  double first = 0, last = 0;
  int zeros = 0;
  const int steps = static_cast<int>(std::lround(periods / (expected * dt)));
  for (int i = 1; i <= steps; ++i) {
    EXPECT_TRUE(move_to(dt * i, m)) << m.failure;
    const double now = sum(m.state.strips[0].points.x), v = sum(m.state.strips[0].points.v);
    if ((before < 0) != (now < 0)) {
      const bool nearer_now = std::abs(now) < std::abs(before);
      last = nearer_now ? dt * i - now / v : dt * (i - 1) - before / v_before;
      if (zeros++ == 0) first = last;
    }
    before = now, v_before = v;
  }
  EXPECT_GE(zeros, 2 * periods - 2);
  return 0.5 * (zeros - 1) / (last - first);
}

/// A uniform cantilever's mode: its shape times beta^2/l^2 is shape'' where the signs of the cosines are flipped.
struct Mode {
  double beta, sigma;
  double shape(double x) const { return part(beta * x, -1); }
  double bending(double x) const { return part(beta * x, 1); }
  double part(double s, double sign) const {
    return std::cosh(s) + sign * std::cos(s) - sigma * (std::sinh(s) + sign * std::sin(s));
  }
  /// Of Euler and Bernoulli's beam: a strip in its plane bends like one.
  double frequency(const geometry::Ribbon& r) const {
    return beta * beta / (2 * kPi * r.length * r.length) * std::sqrt(r.bending_stiffness / r.area_density);
  }
};
constexpr Mode kModes[] = {{1.8751040687, 0.7340955138}, {4.6940911330, 1.0184673188}};

/// Frequency over the beam's, let go from the mode's own bending.
double cantilever_frequency(const Mode& mode, int segments, int steps_a_period) {
  geometry::RibbonSpec spec = sheet(1e-2, true);
  spec.segments = segments;
  constraint::Surroundings held;
  held.supports = {level_clamp(spec, 0)};
  Motion m = make_motion(spec, held);
  const geometry::Ribbon& ribbon = m.path.ribbon;
  geometry::Chain chain = geometry::straight_chain(ribbon, held.supports[0].motion.keys[0].pose);
  std::vector<Vec3> weight;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(segments); ++i) {
    const double x = ribbon.node_u[i] / ribbon.length;
    // The half cell at the clamp stands for its middle.
    const double at = i == 0 ? 0.25 / segments : x;
    if (geometry::kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = 1e-3 / ribbon.length * mode.bending(at);
    weight.push_back(ribbon.node_mass[i] * mode.shape(x) * Vec3::UnitZ());
  }
  start(chain, m);
  const double expected = mode.frequency(ribbon);
  return frequency(weight, expected, 4, 1 / (expected * steps_a_period), m) / expected;
}

TEST(Cantilever, OscillatesAsABeam) {
  for (const Mode& mode : kModes) {
    const double ratio = cantilever_frequency(mode, 50, 200);
    show("frequency / beam's - 1", ratio - 1, 5e-3);
    EXPECT_NEAR(ratio, 1, 5e-3);
  }
}

TEST(Cantilever, FrequencyIsOfSecondOrder) {
  for (const Mode& mode : kModes) {
    const double n0 = cantilever_frequency(mode, 10, 800) - 1, n1 = cantilever_frequency(mode, 20, 800) - 1;
    show("order in segments", std::log2(n0 / n1), 2);
    EXPECT_NEAR(std::log2(n0 / n1), 2, 0.25) << n0 << " " << n1;
    const double t0 = cantilever_frequency(mode, 20, 30), t1 = cantilever_frequency(mode, 20, 60),
                 t2 = cantilever_frequency(mode, 20, 120);
    const double order = std::log2((t0 - t1) / (t1 - t2));
    show("order in time steps", order, 2);
    EXPECT_NEAR(order, 2, 0.25) << t0 << " " << t1 << " " << t2;
  }
}

/// A free ring of radius 1 that swings out of its plane as cos(2 theta), so that it twists: frequency [Hz].
///
/// With turns phi1 about the normal and phi3 about the tangent the ruled surface asks for phi1' = -phi3, the twist is
/// tau = phi3' - phi1, and to second order in them (a dash: along the unit circle)
///   V = D w/2 integral of 2 tau^2 + w^2/12 tau'^2 + phi1 tau,
/// the last term from the ring's own bending; the displacement y has y' = -phi1.   @eq Shen2015:2
double ring_theory(double w, KineticEnergy kinetic) {
  const int k = 2;
  const double tau = k * k - 1;  // for phi1 = cos(k theta)
  const double stiffness = tau + 2 * tau * tau + w * w / 12 * k * k * tau * tau;
  const double turning = kinetic == KineticEnergy::centerline ? 0 : w * w / 12 * (1 + k * k);
  return std::sqrt(stiffness / (1.0 / (k * k) + turning)) / (2 * kPi);
}

double ring_frequency(double w, KineticEnergy kinetic, int segments) {
  geometry::RibbonSpec spec;
  spec.length = 2 * kPi;
  spec.width = w;
  spec.segments = segments;
  spec.closure = geometry::Closure::loop;
  Motion m = make_motion(spec, {}, 1e-9);
  m.options.kinetic = kinetic;
  geometry::Chain chain = geometry::straight_chain(m.path.ribbon, {Vec3::Zero(), straight_frame()});
  std::fill(chain.kappa.begin(), chain.kappa.end(), 1.0);
  start(chain, m);
  const auto n = static_cast<std::size_t>(segments);
  const geometry::State shape = implicit::shape_of(m.path, m.state);
  const Vec3 d2 = straight_frame() * Vec3::UnitY();
  const double speed = 1e-3, k = 2;
  std::vector<Vec3> weight;
  for (std::size_t i = 0; i <= n; ++i) {
    const double theta = 2 * kPi * static_cast<double>(i) / segments;
    m.state.strips[0].points.v[i] = -speed / k * std::sin(k * theta) * d2;
    weight.push_back(m.path.ribbon.node_mass[i] * std::sin(k * theta) * d2);
  }
  for (std::size_t s = 0; n + 1 + s < m.state.strips[0].points.v.size(); ++s) {
    const double theta = 2 * kPi * (static_cast<double>(s) + 0.5) / segments;
    const Mat3 frame = shape.q[s].toRotationMatrix();
    m.state.strips[0].points.v[n + 1 + s] =
        speed * (std::cos(k * theta) * frame.col(2) - k * std::sin(k * theta) * frame.col(0));
  }
  implicit::find_accelerations(implicit::Paths(&m.path, 1), m.options, m.state, m.work);
  const double expected = ring_theory(w, kinetic);
  return frequency(weight, expected, 4, 1 / (400 * expected), m);
}

/// Out of its plane the ring cannot bend without twisting: the inertia of its width slows it.
TEST(Ring, TwistsAtTheFrequencyOfTheory) {
  const double w = 0.6;
  for (const auto kinetic : {KineticEnergy::centerline, KineticEnergy::rotary, KineticEnergy::full}) {
    std::vector<double> error;
    for (const int n : {20, 40, 80}) error.push_back(ring_frequency(w, kinetic, n) / ring_theory(w, kinetic) - 1);
    std::printf("  frequency / theory - 1: n = 20 %.3g, n = 40 %.3g\n", error[0], error[1]);
    show("frequency / theory - 1, n = 80", error[2], 5e-3);
    EXPECT_LE(std::abs(error[2]), 5e-3);
    EXPECT_NEAR(std::log2(std::abs(error[0] - error[1]) / std::abs(error[1] - error[2])), 2, 0.3);
  }
  EXPECT_LT(ring_theory(w, KineticEnergy::full), 0.85 * ring_theory(w, KineticEnergy::centerline));
}

}  // namespace
}  // namespace wunderlich::testing
