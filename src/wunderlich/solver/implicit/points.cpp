#include "wunderlich/solver/implicit/points.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::solver::implicit {

Scheme make_scheme(Integrator kind, double rho, double h, double h_before) {
  Scheme s;
  s.kind = kind == Integrator::bdf2 && h_before == 0 ? Integrator::euler : kind;
  s.h = h;
  switch (s.kind) {
    case Integrator::euler:
      s.stiffness = 1 / (h * h);
      s.v0 = h;
      s.error = 0.5 * h * h;
      break;
    case Integrator::bdf2: {
      const double r = h / h_before, a = (1 + r) * (1 + r) / (1 + 2 * r), b = r * r / (1 + 2 * r);
      const double k = h * (1 + r) / (1 + 2 * r);
      s.stiffness = 1 / (k * k);
      s.x0 = a, s.xb = -b;
      s.v0 = k * a, s.vb = -k * b;
      s.error = h * h * 2 / 9;
      break;
    }
    case Integrator::generalised_alpha:
      s.alpha_m = (2 * rho - 1) / (rho + 1);
      s.alpha_f = rho / (rho + 1);
      s.gamma = 0.5 - s.alpha_m + s.alpha_f;
      s.beta = 0.25 * (1 - s.alpha_m + s.alpha_f) * (1 - s.alpha_m + s.alpha_f);
      s.stiffness = (1 - s.alpha_m) / (s.beta * h * h * (1 - s.alpha_f));
      s.v0 = h;
      s.a0 = h * h * (0.5 - s.beta - s.beta * s.alpha_m / (1 - s.alpha_m));
      s.true0 = h * h * s.beta * s.alpha_f / (1 - s.alpha_m);
      s.error = h * h * std::abs(s.beta - 1.0 / 6);
      break;
  }
  return s;
}

void resize(std::size_t count, Points& points) {
  for (auto* list : {&points.x, &points.v, &points.a, &points.acceleration, &points.x_before, &points.v_before}) {
    list->assign(count, Vec3::Zero());
  }
}

double finish(const Scheme& s, const std::vector<Vec3>& x, Points& p) {
  double error = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 acceleration = s.stiffness * (x[i] - anchor(s, p, i));
    const Vec3 x0 = p.x[i], v0 = p.v[i], a0 = p.a[i], true0 = p.acceleration[i];
    switch (s.kind) {
      case Integrator::euler:
        p.v[i] = (x[i] - x0) / s.h;
        p.a[i] = acceleration;
        break;
      case Integrator::bdf2:
        p.v[i] = std::sqrt(s.stiffness) * (x[i] - s.x0 * x0 - s.xb * p.x_before[i]);
        p.a[i] = acceleration;
        break;
      case Integrator::generalised_alpha:
        p.a[i] = ((1 - s.alpha_f) * acceleration + s.alpha_f * true0 - s.alpha_m * a0) / (1 - s.alpha_m);
        p.v[i] = v0 + s.h * ((1 - s.gamma) * a0 + s.gamma * p.a[i]);
        break;
    }
    p.acceleration[i] = acceleration;
    p.x[i] = x[i];
    p.x_before[i] = x0;
    p.v_before[i] = v0;
    // Euler misses the acceleration itself, the others its change.
    const Vec3 missed = s.kind == Integrator::euler ? acceleration : Vec3(acceleration - true0);
    error = std::max(error, s.error * missed.norm());
  }
  return error;
}

}  // namespace wunderlich::solver::implicit
