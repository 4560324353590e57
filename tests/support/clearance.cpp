#include "support/clearance.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace wunderlich::testing {

namespace {

constexpr int kCells = 12;  // of a facet's sides, at whose corners points are

struct Facet {
  std::array<Vec3, 4> corner;
  double low = 0, high = 0;  ///< its stretch of the flat pattern [m]
};

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  return (a + std::clamp(way.dot(p - a) / way.squaredNorm(), 0.0, 1.0) * way - p).norm();
}

double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double rim = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  const Vec3 normal = (b - a).cross(c - a);
  const auto inside = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(p - from)) >= 0; };
  return inside(a, b) && inside(b, c) && inside(c, a) ? std::abs(normal.normalized().dot(p - a)) : rim;
}

std::vector<Facet> facets_of(const solver::StripPlace& strip) {
  std::vector<Facet> out(static_cast<std::size_t>(strip.ribbon.segments));
  for (std::size_t s = 0; s < out.size(); ++s) {
    out[s].low = std::numeric_limits<double>::infinity(), out[s].high = -out[s].low;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t node = s + k / 2;
      const double v = (k == 1 || k == 2 ? 0.5 : -0.5) * strip.ribbon.width, eta = strip.chain.eta[node];
      const Mat3& frame = strip.kinematics.frame[node];
      out[s].corner[k] = strip.kinematics.r[node] + v * (frame.col(1) + eta * frame.col(2));
      const double u = strip.ribbon.node_u[node] + v * eta;
      out[s].low = std::min(out[s].low, u), out[s].high = std::max(out[s].high, u);
    }
  }
  return out;
}

double between(const Facet& points, const Facet& facet) {
  double least = std::numeric_limits<double>::infinity();
  const auto& [a, b, c, d] = points.corner;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      const double f = static_cast<double>(i) / kCells, g = static_cast<double>(j) / kCells;
      const Vec3 p = (1 - f) * ((1 - g) * a + g * b) + f * ((1 - g) * d + g * c);
      const auto& x = facet.corner;
      least = std::min({least, to_triangle(p, x[0], x[1], x[2]), to_triangle(p, x[0], x[2], x[3])});
    }
  }
  return least;
}

/// No pair of points of two facets is nearer than this.
double bound(const Facet& a, const Facet& b) {
  const auto middle = [](const Facet& f) -> Vec3 {
    return 0.25 * (f.corner[0] + f.corner[1] + f.corner[2] + f.corner[3]);
  };
  const auto radius = [&](const Facet& f) {
    double most = 0;
    for (const Vec3& x : f.corner) most = std::max(most, (x - middle(f)).norm());
    return most;
  };
  return (middle(a) - middle(b)).norm() - radius(a) - radius(b);
}

/// Between the stretches of two facets in the flat pattern; round a loop the shorter way.
double flat_gap(const geometry::Ribbon& ribbon, const Facet& a, const Facet& b) {
  const auto gap = [&](double shift) { return std::max(a.low + shift - b.high, b.low - a.high - shift); };
  return ribbon.is_loop() ? std::min({gap(-ribbon.length), gap(0), gap(ribbon.length)}) : gap(0);
}

}  // namespace

double clearance(std::span<const solver::StripPlace> strips, double apart) {
  double least = std::numeric_limits<double>::infinity();
  for (const solver::StripPlace& one : strips) {
    const std::vector<Facet> points = facets_of(one);
    for (const solver::StripPlace& other : strips) {
      for (const Facet& facet : facets_of(other)) {
        for (const Facet& from : points) {
          if (&one == &other && flat_gap(one.ribbon, facet, from) <= apart) continue;
          if (bound(from, facet) < least) least = std::min(least, between(from, facet));
        }
      }
    }
  }
  return least;
}

}  // namespace wunderlich::testing
