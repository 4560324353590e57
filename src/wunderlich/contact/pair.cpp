#include "wunderlich/contact/pair.hpp"

#include <cmath>

#include "wunderlich/contact/barrier.hpp"

namespace wunderlich::contact {

namespace {

/// Sine squared of the angle between two directions below which they span no plane: rounding would choose the nearest
/// point.
constexpr double kParallel = 1e-14;

/// Nearest points with the parameters that are free to move them: none between two corners, one along an edge, two in
/// a triangle or along two edges.
struct Place {
  PairNearest nearest;
  int free = 0;
  Vec4 slopes[2];  ///< of the weights, by each free parameter
};

Vec3 combine(const Vec4& weights, const PairPoints& x) {
  return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2] + weights[3] * x[3];
}

void keep_nearer(const Place& place, Place& best) {
  if (place.nearest.distance < best.nearest.distance) best = place;
}

void measure(const PairPoints& x, Place& place) {
  place.nearest.way = combine(place.nearest.weights, x);
  place.nearest.distance = place.nearest.way.norm();
}

/// Point p against the edge between a and b; `sign` is p's: 1 if it belongs to the first primitive, else -1.
Place at_edge(const PairPoints& x, int p, int a, int b, double sign) {
  const auto at = [&](int i) -> const Vec3& { return x[static_cast<std::size_t>(i)]; };
  const Vec3 edge = at(b) - at(a);
  const double squared = edge.squaredNorm(), along = (at(p) - at(a)).dot(edge);
  Place place;
  double t = 0;
  if (along > 0) t = along < squared ? along / squared : 1;
  place.nearest.weights.setZero();
  place.nearest.weights[p] = sign;
  place.nearest.weights[a] = -sign * (1 - t);
  place.nearest.weights[b] = -sign * t;
  if (along > 0 && along < squared) {
    place.free = 1;
    place.slopes[0].setZero();
    place.slopes[0][a] = sign;
    place.slopes[0][b] = -sign;
  }
  measure(x, place);
  return place;
}

/// Both parameters of e + s a + t b, |e + s a + t b| least; false where a and b span no plane.
bool solve_both(const Vec3& e, const Vec3& a, const Vec3& b, double& s, double& t) {
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  const double det = a.cross(b).squaredNorm();
  if (!(det > kParallel * aa * bb)) return false;
  const double ea = e.dot(a), eb = e.dot(b);
  s = (ab * eb - bb * ea) / det;
  t = (ab * ea - aa * eb) / det;
  return true;
}

Place place_in_triangle(const PairPoints& x) {
  Place best = at_edge(x, 0, 1, 2, 1);
  keep_nearer(at_edge(x, 0, 2, 3, 1), best);
  keep_nearer(at_edge(x, 0, 3, 1, 1), best);
  double s = 0, t = 0;
  if (!solve_both(x[0] - x[1], x[1] - x[2], x[1] - x[3], s, t) || !(s > 0 && t > 0 && s + t < 1)) return best;
  Place inside;
  inside.nearest.weights = {1, s + t - 1, -s, -t};
  inside.free = 2;
  inside.slopes[0] = {0, 1, -1, 0};
  inside.slopes[1] = {0, 1, 0, -1};
  measure(x, inside);
  keep_nearer(inside, best);
  return best;
}

Place place_on_edges(const PairPoints& x) {
  Place best = at_edge(x, 0, 2, 3, 1);
  keep_nearer(at_edge(x, 1, 2, 3, 1), best);
  keep_nearer(at_edge(x, 2, 0, 1, -1), best);
  keep_nearer(at_edge(x, 3, 0, 1, -1), best);
  double s = 0, t = 0;
  if (!solve_both(x[0] - x[2], x[1] - x[0], x[2] - x[3], s, t) || !(s > 0 && s < 1 && t > 0 && t < 1)) return best;
  Place inside;
  inside.nearest.weights = {1 - s, s, t - 1, -t};
  inside.free = 2;
  inside.slopes[0] = {-1, 1, 0, 0};
  inside.slopes[1] = {0, 0, 1, -1};
  measure(x, inside);
  keep_nearer(inside, best);
  return best;
}

Place place_of(PairKind kind, const PairPoints& x) {
  return kind == PairKind::vertex_triangle ? place_in_triangle(x) : place_on_edges(x);
}

/// Derivatives of the distance d = |e|, e the sum of weights times points, whose free parameters p keep e.de/dp = 0.
/// With e_a = de/dp_a, C_ab = e_a.e_b, n = e/d and w'_a = dw/dp_a the Hessian of d^2/2, w w^T I - F^T C^-1 F with F_a =
/// w e_a + w'_a e, gives that of d:   w w^T Q/d - C^-1_ab (w e_a w'_b n^T + w'_a n w e_b^T) - d C^-1_ab w'_a w'_b n
/// n^T. Q, what n and all e_a leave of the identity, is formed without differences: 1/d is large where bodies touch.
void add_distance_hessian(const Place& place, const PairPoints& x, double factor, Mat12& hessian) {
  const double d = place.nearest.distance;
  const Vec3 n = place.nearest.way / d;
  const Vec4& w = place.nearest.weights;
  Vec3 e[2] = {Vec3::Zero(), Vec3::Zero()};
  for (int a = 0; a < place.free; ++a) e[a] = combine(place.slopes[a], x);
  Mat2 inverse = Mat2::Zero();
  Mat3 rest = Mat3::Zero();
  if (place.free == 2) {
    const double det = e[0].cross(e[1]).squaredNorm(), across = -e[0].dot(e[1]) / det;
    inverse << e[1].squaredNorm() / det, across, across, e[0].squaredNorm() / det;
  } else if (place.free == 1) {
    inverse(0, 0) = 1 / e[0].squaredNorm();
    const Vec3 third = n.cross(e[0]).normalized();
    rest = third * third.transpose();
  } else {
    rest = Mat3::Identity() - n * n.transpose();
  }
  rest *= factor / d;
  // turn_a = sum_b C^-1_ab e_b: how far parameter a goes when n turns
  Vec3 turn[2];
  for (int a = 0; a < 2; ++a) turn[a] = inverse(a, 0) * e[0] + inverse(a, 1) * e[1];
  const Mat3 normal = n * n.transpose();
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < 4; ++l) {
      Mat3 block = w[k] * w[l] * rest;
      for (int a = 0; a < place.free; ++a) {
        const Mat3 outer = turn[a] * n.transpose();
        block -= factor * (w[k] * place.slopes[a][l] * outer + place.slopes[a][k] * w[l] * outer.transpose());
        for (int b = 0; b < place.free; ++b) {
          block -= factor * d * inverse(a, b) * place.slopes[a][k] * place.slopes[b][l] * normal;
        }
      }
      hessian.block<3, 3>(3 * k, 3 * l) += block;
    }
  }
}

/// The factor that weakens the barrier of edges that are nearly parallel, by c = |u x v|^2 (Li2020, nearly parallel
/// edges)
struct Mollifier {
  double value = 1, first = 0, second = 0;
};

Mollifier mollifier(PairKind kind, const PairPoints& x, double parallel) {
  if (kind == PairKind::vertex_triangle) return {};
  const double c = (x[1] - x[0]).cross(x[3] - x[2]).squaredNorm();
  if (c >= parallel) return {};
  const double share = c / parallel;
  return {share * (2 - share), 2 * (1 - share) / parallel, -2 / (parallel * parallel)};
}

/// First and second derivatives of c = |u|^2 |v|^2 - (u.v)^2 by the ends of both edges.
void cross_derivatives(const PairPoints& x, Vec12& gradient, Mat12& hessian) {
  const Vec3 u = x[1] - x[0], v = x[3] - x[2];
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const Vec3 by_u = 2 * (vv * u - uv * v), by_v = 2 * (uu * v - uv * u);
  const Mat3 one = Mat3::Identity();
  const Mat3 twice_u = 2 * (vv * one - v * v.transpose()), twice_v = 2 * (uu * one - u * u.transpose());
  const Mat3 both = 2 * (2 * u * v.transpose() - v * u.transpose() - uv * one);
  gradient << -by_u, by_u, -by_v, by_v;
  hessian << twice_u, -twice_u, both, -both,                   //
      -twice_u, twice_u, -both, both,                          //
      both.transpose(), -both.transpose(), twice_v, -twice_v,  //
      -both.transpose(), both.transpose(), -twice_v, twice_v;
}

/// Product of barrier and mollifier: what the latter's derivatives add.
void add_mollifier(const PairPoints& x, const Barrier& b, const Mollifier& m, const Vec12& along, PairEnergy& energy) {
  Vec12 turn;
  Mat12 bend;
  cross_derivatives(x, turn, bend);
  energy.gradient += m.first * b.value * turn;
  energy.hessian += m.first * b.first * (along * turn.transpose() + turn * along.transpose());
  energy.hessian += m.second * b.value * turn * turn.transpose();
  energy.hessian += m.first * b.value * bend;
}

}  // namespace

PairNearest pair_nearest(PairKind kind, const PairPoints& x) { return place_of(kind, x).nearest; }

double pair_distance(PairKind kind, const PairPoints& x) { return place_of(kind, x).nearest.distance; }

double pair_value(PairKind kind, const PairPoints& x, const Gap& gap) {
  const double value = barrier(pair_distance(kind, x) - gap.offset, gap.reach).value;
  if (value == 0 || !std::isfinite(value)) return value;
  return value * mollifier(kind, x, gap.parallel).value;
}

PairEnergy pair_energy(PairKind kind, const PairPoints& x, const Gap& gap) {
  PairEnergy energy{0, Vec12::Zero(), Mat12::Zero(), Vec12::Zero(), 0};
  const Place place = place_of(kind, x);
  const Barrier b = barrier(place.nearest.distance - gap.offset, gap.reach);
  energy.value = b.value;
  if (b.value == 0 || !std::isfinite(b.value)) return energy;
  const Mollifier m = mollifier(kind, x, gap.parallel);
  energy.value *= m.value;
  const Vec3 n = place.nearest.way / place.nearest.distance;
  Vec12& along = energy.along;
  for (int k = 0; k < 4; ++k) along.segment<3>(3 * k) = place.nearest.weights[k] * n;
  energy.gradient = m.value * b.first * along;
  energy.second = m.value * b.second;
  energy.hessian = energy.second * along * along.transpose();
  add_distance_hessian(place, x, m.value * b.first, energy.hessian);
  if (m.first != 0) add_mollifier(x, b, m, along, energy);
  return energy;
}

}  // namespace wunderlich::contact
