// The integrators alone, on harmonic oscillators: order, stability, what is left of fast oscillations, local error.
#include "wunderlich/solver/implicit/points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "implicit/motions.hpp"

namespace wunderlich::testing {
namespace {

using implicit::Integrator;
using implicit::Points;
using implicit::Scheme;

/// x'' = -x (rate/1 s)^2 from x = 1 at rest.
struct Oscillator {
  Integrator kind;
  double rho = 0;
  double rate = 1;
  double last_step = 0;
  Points points;

  Oscillator(Integrator k, double left, double w) : kind(k), rho(left), rate(w) {
    implicit::resize(1, points);
    points.x[0] = Vec3::UnitX();
    points.a[0] = points.acceleration[0] = -rate * rate * points.x[0];
  }

  /// The minimum of c/2 (x - anchor)^2 + rate^2/2 x^2; returns the estimate of the local error.
  double step(double h) {
    const Scheme scheme = implicit::make_scheme(kind, rho, h, last_step);
    last_step = h;
    const double share = scheme.stiffness / (scheme.stiffness + rate * rate);
    return implicit::finish(scheme, {share * implicit::anchor(scheme, points, 0)}, points);
  }
};

/// Error of position and velocity after 5 s in `steps` steps whose lengths vary by +- `uneven`.
double error_after(Integrator kind, double rho, int steps, double uneven) {
  Oscillator o(kind, rho, 1);
  const double mean = 5.0 / steps;
  for (int i = 0; i < steps; ++i) o.step(mean * (1 + (i % 2 == 0 ? uneven : -uneven)));
  return std::hypot(o.points.x[0].x() - std::cos(5.0), o.points.v[0].x() + std::sin(5.0));
}

void expect_order(const std::string& name, Integrator kind, double rho, double uneven, double order) {
  const double coarse = error_after(kind, rho, 1000, uneven), fine = error_after(kind, rho, 2000, uneven);
  const double seen = std::log2(coarse / fine);
  show(name + ": order", seen, order);
  EXPECT_NEAR(seen, order, 0.05) << name << " " << coarse << " " << fine;
}

/// @eq Gear1971 @eq ChungHulbert1993
TEST(Integrators, HaveTheirOrder) {
  expect_order("Euler", Integrator::euler, 0, 0, 1);
  expect_order("BDF2", Integrator::bdf2, 0, 0, 2);
  expect_order("BDF2, uneven steps", Integrator::bdf2, 0, 0.3, 2);
  for (const double rho : {0.9, 0.6, 0.3, 0.0}) {
    expect_order("generalised-alpha " + std::to_string(rho), Integrator::generalised_alpha, rho, 0, 2);
  }
}

TEST(Integrators, AreStableAtAnyStep) {
  for (const auto kind : {Integrator::euler, Integrator::bdf2, Integrator::generalised_alpha}) {
    for (const double rho : {0.9, 0.6, 0.3, 0.0}) {
      for (const double h : {0.01, 0.1, 1.0, 3.0, 10.0, 100.0, 1e4}) {
        Oscillator o(kind, rho, 1);
        double early = 0, late = 0;
        for (int i = 0; i < 2000; ++i) {
          o.step(h);
          (i < 1000 ? early : late) = std::max(i < 1000 ? early : late, std::abs(o.points.x[0].x()));
        }
        EXPECT_LE(early, 2) << static_cast<int>(kind) << " " << rho << " " << h;
        EXPECT_LE(late, early * (1 + 1e-4)) << static_cast<int>(kind) << " " << rho << " " << h;
      }
    }
  }
}

/// What generalised-alpha leaves of an oscillation that a step does not resolve.   @eq ChungHulbert1993
TEST(Integrators, LeaveOfTheFastestOscillationWhatIsAsked) {
  for (const double rho : {0.9, 0.6, 0.3}) {
    Oscillator o(Integrator::generalised_alpha, rho, 1);
    for (int i = 0; i < 100; ++i) o.step(1e5);
    const double before = std::abs(o.points.a[0].x());
    for (int i = 0; i < 100; ++i) o.step(1e5);
    const double left = std::pow(std::abs(o.points.a[0].x()) / before, 1.0 / 100);
    show("left a step of the fastest", left, rho);
    EXPECT_NEAR(left, rho, 0.02 * rho);
  }
}

/// The estimate and the error of one step in the middle of an exact motion.
TEST(Integrators, EstimateTheirLocalError) {
  for (const auto kind : {Integrator::euler, Integrator::bdf2, Integrator::generalised_alpha}) {
    const double h = 1e-3, t = 0.7;
    Oscillator o(kind, 0.9, 1);
    const auto x = [](double at) { return Vec3(std::cos(at), 0, 0); };
    const auto v = [](double at) { return Vec3(-std::sin(at), 0, 0); };
    o.points.x[0] = x(t), o.points.v[0] = v(t);
    o.points.x_before[0] = x(t - h), o.points.v_before[0] = v(t - h);
    o.points.acceleration[0] = -x(t);
    // The auxiliary acceleration is the true one at another time.
    const Scheme s = implicit::make_scheme(kind, 0.9, h, h);
    o.points.a[0] = -x(t + (s.alpha_m - s.alpha_f) * h);
    o.last_step = h;
    const double estimate = o.step(h), truth = std::abs(o.points.x[0].x() - std::cos(t + h));
    show("local error, estimated over true", estimate / truth, 1);
    EXPECT_GT(estimate, 0.3 * truth) << static_cast<int>(kind);
    EXPECT_LT(estimate, 3 * truth) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace wunderlich::testing
