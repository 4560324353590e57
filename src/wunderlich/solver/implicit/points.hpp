/// Points of space in time: the integrators turn one step of M x'' + f(x) = 0 into a minimisation, in which a spring
/// of stiffness c M ties each point to its anchor.
#pragma once

#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::solver::implicit {

enum class Integrator {
  euler,              ///< first order, strongly damped
  bdf2,               ///< second order, damps what a step does not resolve   @eq Gear1971 (variable steps)
  generalised_alpha,  ///< second order, damping by choice   @eq ChungHulbert1993 @eq ArnoldBruls2007
};

/// Everything that is kept of the points from step to step.
struct Points {
  std::vector<Vec3> x, v;                ///< [m, m/s] (directions: 1, 1/s)
  std::vector<Vec3> a;                   ///< generalised-alpha: its auxiliary acceleration
  std::vector<Vec3> acceleration;        ///< the true one: -f/M with every reaction
  std::vector<Vec3> x_before, v_before;  ///< one step earlier, for BDF2
};

/// Coefficients of one step.
struct Scheme {
  Integrator kind = Integrator::euler;
  double h = 0;                                              ///< [s]
  double stiffness = 0;                                      ///< c [1/s^2]
  double x0 = 1, v0 = 0, a0 = 0, true0 = 0, xb = 0, vb = 0;  ///< the anchor as a combination of what is kept
  double alpha_m = 0, alpha_f = 0, beta = 0, gamma = 0;      ///< generalised-alpha
  double error = 0;  ///< local error: times the change of acceleration, Euler: times acceleration [s^2]
};

/// `h_before`: the step before, 0 if there was none (BDF2 then starts with Euler). `rho`: share of the fastest
/// oscillation that generalised-alpha leaves after a step, in [0, 1].
Scheme make_scheme(Integrator kind, double rho, double h, double h_before);

/// Where point i would be at the end of the step if nothing but its inertia moved it [m].
inline Vec3 anchor(const Scheme& s, const Points& p, std::size_t i) {
  Vec3 x = s.x0 * p.x[i] + s.v0 * p.v[i];
  if (s.kind == Integrator::generalised_alpha) x += s.a0 * p.a[i] + s.true0 * p.acceleration[i];
  if (s.kind == Integrator::bdf2) x += s.xb * p.x_before[i] + s.vb * p.v_before[i];
  return x;
}

/// Makes room for so many points.
void resize(std::size_t count, Points& points);

/// Takes the step's end positions; velocities and accelerations follow. Returns the largest local error of the points.
double finish(const Scheme& scheme, const std::vector<Vec3>& x, Points& points);

}  // namespace wunderlich::solver::implicit
