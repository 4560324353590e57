#include "wunderlich/geometry/topology.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::geometry {

namespace {

constexpr double turn = 2 * std::numbers::pi;

/// A direction along the centerline and the surface normal projected square to it.
struct Direction {
  Vec3 tangent;
  Vec3 normal;
};

Direction direction(const Vec3& along, const Quat& frame) {
  const Vec3 tangent = along.normalized();
  const Vec3 d1 = frame * Vec3::UnitX();
  return {tangent, (d1 - tangent * tangent.dot(d1)).normalized()};
}

/// Angle in (-pi, pi] about b.tangent from a.normal, carried along the shortest rotation, to b.normal.
double turn_between(const Direction& a, const Direction& b) {
  const Quat transport = math::shortest_rotation(a.tangent, b.tangent);
  const Vec3 carried = transport * a.normal;
  return std::atan2(carried.cross(b.normal).dot(b.tangent), carried.dot(b.normal));
}

/// Signed area on the unit sphere from which segments p (a to b) and q (c to d) are seen to cross, over 4 pi;
/// the ordered pair's share of the Gauss integral.
double crossing_share(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ac = c - a, ad = d - a, bc = c - b, bd = d - b;
  const Vec3 ab = b - a, cd = d - c;
  const double triple = cd.cross(ab).dot(ac);
  if (std::abs(triple) <= 1e-13 * ab.norm() * cd.norm() * (ac.norm() + bd.norm())) return 0;
  const std::array<Vec3, 4> faces{ac.cross(ad).normalized(), ad.cross(bd).normalized(), bd.cross(bc).normalized(),
                                  bc.cross(ac).normalized()};
  double area = 0;
  for (std::size_t k = 0; k < 4; ++k) area += std::asin(std::clamp(faces[k].dot(faces[(k + 1) % 4]), -1.0, 1.0));
  return std::copysign(area, triple) / (2 * turn);
}

}  // namespace

double twist(const Ribbon& ribbon, const State& state) {
  const std::size_t segments = state.q.size();
  const auto along = [&](std::size_t s) { return Vec3(state.r[s + 1] - state.r[s]); };
  double angle = 0;
  Direction before = direction(along(0), state.q[0]);
  if (!ribbon.is_loop())
    angle += turn_between(direction(state.end_frame[0] * Vec3::UnitZ(), state.end_frame[0]), before);
  for (std::size_t s = 1; s < segments; ++s) {
    const Direction after = direction(along(s), state.q[s]);
    angle += turn_between(before, after);
    before = after;
  }
  if (ribbon.is_loop()) {
    angle += turn_between(before, direction(along(0), across_seam(ribbon, state.q[0])));
  } else {
    angle += turn_between(before, direction(state.end_frame[1] * Vec3::UnitZ(), state.end_frame[1]));
  }
  return angle / turn;
}

double writhe(const Ribbon& ribbon, const State& state) {
  const std::size_t segments = state.q.size();
  double sum = 0;
  for (std::size_t i = 0; i + 2 < segments; ++i) {
    for (std::size_t j = i + 2; j < segments; ++j) {
      if (ribbon.is_loop() && i == 0 && j + 1 == segments) continue;  // neighbours across the seam
      sum += crossing_share(state.r[i], state.r[i + 1], state.r[j], state.r[j + 1]);
    }
  }
  return 2 * sum;
}

Topology topology(const Ribbon& ribbon, const State& state) {
  Topology out;
  out.twist = twist(ribbon, state);
  out.writhe = writhe(ribbon, state);
  out.link = out.twist + out.writhe;
  return out;
}

std::vector<double> kappa_zeros(const Ribbon& ribbon, const std::vector<double>& kappa) {
  assert(kappa.size() == ribbon.node_u.size());
  double largest = 0;
  for (double k : kappa) largest = std::max(largest, std::abs(k));
  if (largest * ribbon.length < 1e-9) return {};
  const double small = 1e-9 * largest;  // rounding noise of a flat stretch changes its sign at will

  struct Point {
    double u, kappa;
  };
  std::vector<Point> curved;
  const std::size_t nodes = ribbon.is_loop() ? kappa.size() - 1 : kappa.size();
  for (std::size_t i = 0; i < nodes; ++i) {
    if (std::abs(kappa[i]) > small) curved.push_back({ribbon.node_u[i], kappa[i]});
  }
  if (ribbon.is_loop()) {
    assert(!curved.empty());
    const Point first = curved.front();
    curved.push_back({first.u + ribbon.length, ribbon.seam_sign() * first.kappa});
  }
  std::vector<double> zeros;
  for (std::size_t k = 1; k < curved.size(); ++k) {
    const Point& a = curved[k - 1];
    const Point& b = curved[k];
    if (a.kappa * b.kappa > 0) continue;
    const double u = a.u + (b.u - a.u) * (a.kappa / (a.kappa - b.kappa));
    zeros.push_back(std::fmod(u, ribbon.length) / ribbon.length);
  }
  std::sort(zeros.begin(), zeros.end());
  return zeros;
}

}  // namespace wunderlich::geometry
