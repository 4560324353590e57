#include "wunderlich/baseline/rod/energy.hpp"

#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::baseline::rod {

namespace {

/// Two edges that meet, with their sections; what all strains at a node are made of.
struct Bend {
  Vec3 e, f;             ///< edges [m]
  double e_len, f_len;   ///< [m]
  Section before, after;
  double scale;          ///< |e||f| + e.f: the curvature binormal is 2 e x f over it   @eq Bergou2008:1
  double twist;          ///< [rad]
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

/// Derivatives of a node's strains by (e, theta before, f, theta after).
struct StrainSlopes {
  Vec8 soft, hard, twist;
};

/// Adds moment times second derivative of the two curvatures.
void add_bending(const Bend& b, const Vec3& cross, double soft_moment, double hard_moment, Mat8& h) {
  const Vec3 de = soft_moment * b.before.m2 - hard_moment * b.before.m1;
  const Vec3 df = soft_moment * b.after.m2 - hard_moment * b.after.m1;
  const double q = half_bend(b, cross, de + df);
  const Curvatures c = curvatures(b, de + df, q, slopes(b, de + df, q));
  // Carrying a section to a turned edge moves it along the edge only, which the binormal feels to second order.
  const Vec3 quarter_binormal = 0.5 / b.scale * cross;
  h.block<3, 3>(0, 0) += c.ee + both(quarter_binormal, de) / (b.e_len * b.e_len);
  h.block<3, 3>(4, 4) += c.ff + both(quarter_binormal, df) / (b.f_len * b.f_len);
  h.block<3, 3>(0, 4) += c.ef;
  h.block<3, 3>(4, 0) += c.ef.transpose();
  const Vec3 turned_e = -soft_moment * b.before.m1 - hard_moment * b.before.m2;  // derivative of de by theta
  const Vec3 turned_f = -soft_moment * b.after.m1 - hard_moment * b.after.m2;
  for (const auto& [row, turned, self] : {std::tuple(3, turned_e, de), std::tuple(7, turned_f, df)}) {
    const Slopes s = slopes(b, turned, half_bend(b, cross, turned));
    h.block<3, 1>(0, row) += s.e;
    h.block<1, 3>(row, 0) += s.e.transpose();
    h.block<3, 1>(4, row) += s.f;
    h.block<1, 3>(row, 4) += s.f.transpose();
    h(row, row) -= half_bend(b, cross, self);
  }
}

/// Adds moment times second derivative of the twist.   @eq Bergou2010
void add_twisting(const Bend& b, const Vec3& cross, double moment, Mat8& h) {
  const Vec3 &t = b.before.m3, &u = b.after.m3;
  const Vec3 binormal = 2 / b.scale * cross, tilde = (t + u) / (1 + t.dot(u));
  h.block<3, 3>(0, 0) -= moment / (4 * b.e_len * b.e_len) * both(binormal, t + tilde);
  h.block<3, 3>(4, 4) -= moment / (4 * b.f_len * b.f_len) * both(binormal, u + tilde);
  const Mat3 mixed = moment / (2 * b.e_len * b.f_len) * (2 / (1 + t.dot(u)) * math::skew(t) - binormal * tilde.transpose());
  h.block<3, 3>(0, 4) += mixed;
  h.block<3, 3>(4, 0) += mixed.transpose();
}

StrainSlopes strain_slopes(const Bend& b, const Vec3& cross) {
  StrainSlopes out;
  const Vec3 m1 = b.before.m1 + b.after.m1, m2 = b.before.m2 + b.after.m2;
  const Slopes soft = slopes(b, m2, half_bend(b, cross, m2)), hard = slopes(b, -m1, half_bend(b, cross, -m1));
  const auto q = [&](const Vec3& d) { return half_bend(b, cross, d); };
  out.soft << soft.e, -q(b.before.m1), soft.f, -q(b.after.m1);
  out.hard << hard.e, -q(b.before.m2), hard.f, -q(b.after.m2);
  const Vec3 half_binormal = cross / b.scale;
  out.twist << half_binormal / b.e_len, -1, half_binormal / b.f_len, 1;
  return out;
}

/// From edge vectors to nodes: e = x1 - x0, f = x2 - x1.
HingeTerms by_nodes(const Vec8& g, const Mat8& h) {
  Eigen::Matrix<double, 8, 11> rows;  // the Hessian's columns expanded
  rows << -h.leftCols<3>(), h.col(3), h.leftCols<3>() - h.middleCols<3>(4), h.col(7), h.middleCols<3>(4);
  HingeTerms out;
  out.gradient << -g.head<3>(), g[3], g.head<3>() - g.segment<3>(4), g[7], g.segment<3>(4);
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
    const Strain s = strain(rod, state, i);
    const double half = 0.5 * rod.hinge_length[i];
    energy.soft += half * rod.stiffness.soft * s.soft * s.soft;
    energy.hard += half * rod.stiffness.hard * s.hard * s.hard;
    energy.twist += half * rod.stiffness.twist * s.twist * s.twist;
  }
  return energy;
}

HingeTerms hinge_terms(const Rod& rod, const State& state, std::size_t node) {
  const Bend b = bend_at(rod, state, node);
  const Vec3 cross = b.e.cross(b.f);
  const StrainSlopes d = strain_slopes(b, cross);
  const double over = 1 / rod.hinge_length[node];
  const double soft = over * rod.stiffness.soft, hard = over * rod.stiffness.hard, twist = over * rod.stiffness.twist;
  const double soft_moment = soft * half_bend(b, cross, b.before.m2 + b.after.m2);
  const double hard_moment = -hard * half_bend(b, cross, b.before.m1 + b.after.m1);
  const double twist_moment = twist * b.twist;
  const Vec8 gradient = soft_moment * d.soft + hard_moment * d.hard + twist_moment * d.twist;
  Mat8 hessian = (soft * d.soft) * d.soft.transpose() + (hard * d.hard) * d.hard.transpose() +
                 (twist * d.twist) * d.twist.transpose();
  add_bending(b, cross, soft_moment, hard_moment, hessian);
  add_twisting(b, cross, twist_moment, hessian);
  return by_nodes(gradient, hessian);
}

EdgeTerms edge_terms(const Rod& rod, const State& state, std::size_t edge) {
  const Vec3 e = state.x[edge + 1] - state.x[edge];
  const double length = e.norm(), l = rod.rest_length[edge], force = rod.stiffness.stretch * (length / l - 1);
  const Mat3 along = e * e.transpose() / (length * length);
  return {force / length * e, rod.stiffness.stretch / l * along + force / length * (Mat3::Identity() - along)};
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
