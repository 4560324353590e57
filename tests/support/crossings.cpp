#include "support/crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wunderlich::testing {

namespace {

using Facet = std::array<Vec3, 4>;

/// Do an edge and a triangle meet? Apart from the solver's test: by where the line meets the plane.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat3 m;
  m << p - q, b - a, c - a;
  if (std::abs(m.determinant()) < 1e-14 * (p - q).norm() * (b - a).norm() * (c - a).norm()) return false;
  const Vec3 x = m.inverse() * (p - a);
  return x[0] >= 0 && x[0] <= 1 && x[1] >= 0 && x[2] >= 0 && x[1] + x[2] <= 1;
}

Facet facet_of(const solver::StripPlace& strip, int segment) {
  const auto corner = [&](int node, double side) -> Vec3 {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 ruling = strip.kinematics.frame[i].col(1) + strip.chain.eta[i] * strip.kinematics.frame[i].col(2);
    return strip.kinematics.r[i] + side * strip.ribbon.width * ruling;
  };
  return {corner(segment, -0.5), corner(segment, 0.5), corner(segment + 1, 0.5), corner(segment + 1, -0.5)};
}

/// Does an edge of one go through the other?
bool goes_through(const Facet& e, const Facet& f) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &p = e[i], &q = e[(i + 1) % 4];
    if (pierces(p, q, f[0], f[1], f[2]) || pierces(p, q, f[0], f[2], f[3])) return true;
  }
  return false;
}

bool are_near(const solver::StripPlace& strip, int s, int t) {
  const int apart = std::abs(s - t), n = strip.ribbon.segments;
  return (strip.ribbon.is_loop() ? std::min(apart, n - apart) : apart) <= 2;
}

}  // namespace

int crossings(std::span<const solver::StripPlace> strips) {
  int count = 0;
  for (const solver::StripPlace& a : strips) {
    for (const solver::StripPlace& b : strips) {
      for (int s = 0; s < a.ribbon.segments; ++s) {
        const Facet facet = facet_of(a, s);
        for (int t = 0; t < b.ribbon.segments; ++t) {
          if (&a == &b && are_near(a, s, t)) continue;
          count += goes_through(facet_of(b, t), facet) ? 1 : 0;
        }
      }
    }
  }
  return count;
}

}  // namespace wunderlich::testing
