#include "wunderlich/baseline/rod/energy.hpp"

#include <cmath>
#include <span>
#include <tuple>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::baseline::rod {

namespace {

/// Two edges that meet, with their sections; what all strains at a node are made of.
struct Bend {
  Vec3 e, f;            ///< edges [m]
  double e_len, f_len;  ///< [m]
  Section before, after;
  double scale;  ///< |e||f| + e.f: the curvature binormal is 2 e x f over it   @eq Bergou2008:1
  double twist;  ///< [rad]
};

Bend bend_at(const Rod& rod, const State& state, std::size_t node) {
  const Joined edges = joined(rod, node);
  Bend b;
  b.before = section(state, edges.before);
  b.after = section(state, edges.after);
  if (rod.half_twists % 2 != 0 && edges.turn != 0) {
    b.after.m1 = -b.after.m1;
    b.after.m2 = -b.after.m2;
  }
  b.e = state.x[edges.before + 1] - state.x[edges.before];
  b.f = state.x[edges.far] - state.x[edges.after];
  b.e_len = b.before.m3.dot(b.e);
  b.f_len = b.after.m3.dot(b.f);
  b.scale = b.e_len * b.f_len + b.e.dot(b.f);
  b.twist = state.theta[edges.after] + edges.turn - state.theta[edges.before] + state.reference_twist[node];
  return b;
}

/// What curvature is measured in: the sections' directions times these.
struct Reading {
  double before, after;
  double weight;  ///< of its energy
};
std::span<const Reading> readings(Bending bending) {
  static constexpr Reading kAveraged[] = {{1, 1, 1}}, kSeparate[] = {{2, 0, 0.5}, {0, 2, 0.5}};
  return bending == Bending::averaged ? std::span<const Reading>(kAveraged) : std::span<const Reading>(kSeparate);
}

/// Half the curvature binormal along `d`: q = d.(e x f)/scale.
double half_bend(const Bend& b, const Vec3& cross, const Vec3& d) { return d.dot(cross) / b.scale; }

/// Derivatives of q by the two edges, `d` fixed.
struct Slopes {
  Vec3 e, f;
};
Slopes slopes(const Bend& b, const Vec3& d, double q) {
  const Vec3 scale_e = b.f_len * b.before.m3 + b.f, scale_f = b.e_len * b.after.m3 + b.e;
  return {(b.f.cross(d) - q * scale_e) / b.scale, (d.cross(b.e) - q * scale_f) / b.scale};
}

struct Curvatures {
  Mat3 ee, ef, ff;
};
/// Second derivatives of q, `d` fixed.
Curvatures curvatures(const Bend& b, const Vec3& d, double q, const Slopes& s) {
  const Vec3 scale_e = b.f_len * b.before.m3 + b.f, scale_f = b.e_len * b.after.m3 + b.e;
  const Vec3 &t = b.before.m3, &u = b.after.m3;
  const double over = 1 / b.scale;
  Curvatures c;
  c.ee = -over * (s.e * scale_e.transpose() + scale_e * s.e.transpose() +
                  q * b.f_len / b.e_len * (Mat3::Identity() - t * t.transpose()));
  c.ff = -over * (s.f * scale_f.transpose() + scale_f * s.f.transpose() +
                  q * b.e_len / b.f_len * (Mat3::Identity() - u * u.transpose()));
  c.ef = -over * (math::skew(d) + s.e * scale_f.transpose() + scale_e * s.f.transpose() +
                  q * (t * u.transpose() + Mat3::Identity()));
  return c;
}

using Vec8 = Eigen::Matrix<double, 8, 1>;
using Mat8 = Eigen::Matrix<double, 8, 8>;

/// A symmetric matrix a b^T + b a^T.
Mat3 both(const Vec3& a, const Vec3& b) { return a * b.transpose() + b * a.transpose(); }

/// Adds moment times second derivative of the two curvatures of a reading.
void add_curving(const Bend& b, const Vec3& cross, const Reading& r, double soft_moment, double hard_moment, Mat8& h) {
  const Vec3 de = r.before * (soft_moment * b.before.m2 - hard_moment * b.before.m1);
  const Vec3 df = r.after * (soft_moment * b.after.m2 - hard_moment * b.after.m1);
  const double q = half_bend(b, cross, de + df);
  const Curvatures c = curvatures(b, de + df, q, slopes(b, de + df, q));
  // Carrying a section to a turned edge moves it along the edge only, which the binormal feels to second order.
  const Vec3 quarter_binormal = 0.5 / b.scale * cross;
  h.block<3, 3>(0, 0) += c.ee + both(quarter_binormal, de) / (b.e_len * b.e_len);
  h.block<3, 3>(4, 4) += c.ff + both(quarter_binormal, df) / (b.f_len * b.f_len);
  h.block<3, 3>(0, 4) += c.ef;
  h.block<3, 3>(4, 0) += c.ef.transpose();
  // Derivatives of these by theta.
  const Vec3 turned_e = r.before * (-soft_moment * b.before.m1 - hard_moment * b.before.m2);
  const Vec3 turned_f = r.after * (-soft_moment * b.after.m1 - hard_moment * b.after.m2);
  for (const auto& [row, turned, self] : {std::tuple(3, turned_e, de), std::tuple(7, turned_f, df)}) {
    const Slopes s = slopes(b, turned, half_bend(b, cross, turned));
    h.block<3, 1>(0, row) += s.e;
    h.block<1, 3>(row, 0) += s.e.transpose();
    h.block<3, 1>(4, row) += s.f;
    h.block<1, 3>(row, 4) += s.f.transpose();
    h(row, row) -= half_bend(b, cross, self);
  }
}

/// One measure of strain by (e, theta before, f, theta after).
struct Measure {
  double strain = 0;
  Vec8 slope;
};

/// Bending about m2 and about m1, by one reading.
std::array<Measure, 2> bending(const Bend& b, const Vec3& cross, const Reading& r) {
  const Vec3 m1 = -(r.before * b.before.m1 + r.after * b.after.m1), m2 = r.before * b.before.m2 + r.after * b.after.m2;
  const auto q = [&](const Vec3& d) { return half_bend(b, cross, d); };
  Measure soft{q(m2), {}}, hard{q(m1), {}};
  const Slopes by_edges_2 = slopes(b, m2, soft.strain), by_edges_1 = slopes(b, m1, hard.strain);
  soft.slope << by_edges_2.e, -r.before * q(b.before.m1), by_edges_2.f, -r.after * q(b.after.m1);
  hard.slope << by_edges_1.e, -r.before * q(b.before.m2), by_edges_1.f, -r.after * q(b.after.m2);
  return {soft, hard};
}

/// @eq Bergou2010
Measure twisting(const Bend& b, const Vec3& cross) {
  Measure out{b.twist, {}};
  out.slope << cross / (b.scale * b.e_len), -1, cross / (b.scale * b.f_len), 1;
  return out;
}

/// Adds moment times second derivative of the twist.   @eq Bergou2010
void add_twisted_turning(const Bend& b, const Vec3& cross, double moment, Mat8& h) {
  const Vec3 &t = b.before.m3, &u = b.after.m3;
  const Vec3 binormal = 2 / b.scale * cross, tilde = (t + u) / (1 + t.dot(u));
  h.block<3, 3>(0, 0) -= moment / (4 * b.e_len * b.e_len) * both(binormal, t + tilde);
  h.block<3, 3>(4, 4) -= moment / (4 * b.f_len * b.f_len) * both(binormal, u + tilde);
  const Mat3 mixed =
      moment / (2 * b.e_len * b.f_len) * (2 / (1 + t.dot(u)) * math::skew(t) - binormal * tilde.transpose());
  h.block<3, 3>(0, 4) += mixed;
  h.block<3, 3>(4, 0) += mixed.transpose();
}

/// Adds the energy stiffness strain^2/2 of a measure, but for what its second derivative makes.
void add_measure(const Measure& m, double stiffness, Vec8& g, Mat8& h) {
  g += (stiffness * m.strain) * m.slope;
  h += (stiffness * m.slope) * m.slope.transpose();
}

/// From edge vectors to nodes: e = x1 - x0, f = x2 - x1.
Vec11 by_nodes(const Vec8& g) {
  Vec11 out;
  out << -g.head<3>(), g[3], g.head<3>() - g.segment<3>(4), g[7], g.segment<3>(4);
  return out;
}

HingeTerms by_nodes(const Vec8& g, const Mat8& h) {
  Eigen::Matrix<double, 8, 11> rows;  // the Hessian's columns expanded
  rows << -h.leftCols<3>(), h.col(3), h.leftCols<3>() - h.middleCols<3>(4), h.col(7), h.middleCols<3>(4);
  HingeTerms out;
  out.gradient = by_nodes(g);
  out.hessian << -rows.topRows<3>(), rows.row(3), rows.topRows<3>() - rows.middleRows<3>(4), rows.row(7),
      rows.middleRows<3>(4);
  return out;
}

}  // namespace

Strain strain(const Rod& rod, const State& state, std::size_t node) {
  const Bend b = bend_at(rod, state, node);
  const Vec3 cross = b.e.cross(b.f);
  const double over = 1 / rod.hinge_length[node];
  return {over * half_bend(b, cross, b.before.m2 + b.after.m2), -over * half_bend(b, cross, b.before.m1 + b.after.m1),
          over * b.twist};
}

Energy elastic_energy(const Rod& rod, const State& state) {
  Energy energy;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const double l = rod.rest_length[j], stretched = (state.x[j + 1] - state.x[j]).norm() / l - 1;
    energy.stretch += 0.5 * rod.stiffness.stretch * l * stretched * stretched;
  }
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const Bend b = bend_at(rod, state, i);
    const Vec3 cross = b.e.cross(b.f);
    const double half = 0.5 / rod.hinge_length[i];
    for (const Reading& r : readings(rod.bending)) {
      const double soft = half_bend(b, cross, r.before * b.before.m2 + r.after * b.after.m2);
      const double hard = half_bend(b, cross, r.before * b.before.m1 + r.after * b.after.m1);
      energy.soft += half * r.weight * rod.stiffness.soft * soft * soft;
      energy.hard += half * r.weight * rod.stiffness.hard * hard * hard;
    }
    energy.twist += half * rod.stiffness.twist * b.twist * b.twist;
  }
  return energy;
}

HingeTerms hinge_terms(const Rod& rod, const State& state, std::size_t node, const double* stress) {
  const Bend b = bend_at(rod, state, node);
  const Vec3 cross = b.e.cross(b.f);
  const double over = 1 / rod.hinge_length[node];
  const auto next = [&](double own) { return stress == nullptr ? own : *stress++; };
  Vec8 gradient = Vec8::Zero();
  Mat8 hessian = Mat8::Zero();
  for (const Reading& r : readings(rod.bending)) {
    const double soft = r.weight * over * rod.stiffness.soft, hard = r.weight * over * rod.stiffness.hard;
    const auto [about_m2, about_m1] = bending(b, cross, r);
    add_measure(about_m2, soft, gradient, hessian);
    add_measure(about_m1, hard, gradient, hessian);
    const double soft_moment = next(soft * about_m2.strain), hard_moment = next(hard * about_m1.strain);
    add_curving(b, cross, r, soft_moment, hard_moment, hessian);
  }
  const Measure twist = twisting(b, cross);
  const double stiffness = over * rod.stiffness.twist;
  add_measure(twist, stiffness, gradient, hessian);
  add_twisted_turning(b, cross, next(stiffness * twist.strain), hessian);
  return by_nodes(gradient, hessian);
}

Measures measures(const Rod& rod, const State& state, std::size_t node) {
  const Bend b = bend_at(rod, state, node);
  const Vec3 cross = b.e.cross(b.f);
  const double over = 1 / rod.hinge_length[node];
  Measures out;
  const auto add = [&](const Measure& m, double stiffness) {
    const auto k = static_cast<std::size_t>(out.count++);
    out.strain[k] = m.strain;
    out.stiffness[k] = stiffness;
    out.slope[k] = by_nodes(m.slope);
  };
  for (const Reading& r : readings(rod.bending)) {
    const auto [about_m2, about_m1] = bending(b, cross, r);
    add(about_m2, r.weight * over * rod.stiffness.soft);
    add(about_m1, r.weight * over * rod.stiffness.hard);
  }
  add(twisting(b, cross), over * rod.stiffness.twist);
  return out;
}

double tension(const Rod& rod, const State& state, std::size_t edge) {
  return rod.stiffness.stretch * ((state.x[edge + 1] - state.x[edge]).norm() / rod.rest_length[edge] - 1);
}

EdgeTerms edge_terms(const Rod& rod, const State& state, std::size_t edge, double turned) {
  const Vec3 e = state.x[edge + 1] - state.x[edge];
  const double length = e.norm(), l = rod.rest_length[edge];
  const Mat3 along = e * e.transpose() / (length * length);
  return {tension(rod, state, edge) / length * e,
          rod.stiffness.stretch / l * along + turned / length * (Mat3::Identity() - along)};
}

std::array<std::size_t, 11> hinge_coordinates(const Rod& rod, std::size_t node) {
  const Joined edges = joined(rod, node);
  std::array<std::size_t, 11> out;
  for (std::size_t k = 0; k < 4; ++k) {
    out[k] = 4 * edges.before + k;
    out[4 + k] = 4 * edges.after + k;
    if (k < 3) out[8 + k] = 4 * edges.far + k;
  }
  return out;
}

}  // namespace wunderlich::baseline::rod
