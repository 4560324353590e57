#include "wunderlich/baseline/rod/rod.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "wunderlich/baseline/rod/frames.hpp"

namespace wunderlich::baseline::rod {

namespace {

using std::numbers::pi;

State empty_state(const Rod& rod) {
  State state;
  state.x.assign(rod.nodes(), Vec3::Zero());
  state.v.assign(rod.nodes(), Vec3::Zero());
  state.theta.assign(rod.edges(), 0.0);
  state.theta_dot.assign(rod.edges(), 0.0);
  state.reference.assign(rod.edges(), Vec3::UnitZ());
  state.reference_twist.assign(rod.nodes(), 0.0);
  return state;
}

}  // namespace

Stiffness rectangle(double youngs_modulus, double poisson_ratio, double width, double thickness) {
  const double h = thickness, w = width, shear = youngs_modulus / (2 * (1 + poisson_ratio));
  Stiffness s;
  s.stretch = youngs_modulus * w * h;
  s.soft = youngs_modulus * w * h * h * h / 12;
  s.hard = youngs_modulus * h * w * w * w / 12;
  s.twist = shear * w * h * h * h / 3 * (1 - 0.63 * h / w);
  return s;
}

Stiffness physical(const geometry::RibbonSpec& spec, double poisson_ratio, double thickness) {
  const double youngs_modulus =
      12 * spec.bending_stiffness * (1 - poisson_ratio * poisson_ratio) / (thickness * thickness * thickness);
  return rectangle(youngs_modulus, poisson_ratio, spec.width, thickness);
}

Stiffness paper_ratio(const geometry::RibbonSpec& spec) {
  Stiffness s;
  s.soft = spec.bending_stiffness * spec.width;
  s.hard = 1e4 * s.soft;
  s.twist = 2 * s.soft;
  s.stretch = 12 * s.hard / (spec.width * spec.width);
  return s;
}

Rod make_rod(const geometry::RibbonSpec& spec, const Stiffness& stiffness) {
  geometry::RibbonSpec unclamped = spec;
  unclamped.clamped = {false, false};
  const geometry::Ribbon ribbon = geometry::make_ribbon(unclamped);
  Rod rod;
  rod.segments = ribbon.segments;
  rod.closure = ribbon.closure;
  rod.half_twists = ribbon.half_twists;
  rod.length = ribbon.length;
  rod.width = ribbon.width;
  rod.stiffness = stiffness;
  rod.area_density = ribbon.area_density;
  rod.rest_length = ribbon.rest_length;
  rod.hinge_length = ribbon.hinge_length;
  rod.node_mass = ribbon.node_mass;
  for (double l : rod.rest_length) {
    rod.edge_inertia.push_back(ribbon.area_density * ribbon.width * ribbon.width * ribbon.width / 12 * l);
  }
  return rod;
}

State straight_state(const Rod& rod) {
  State state = empty_state(rod);
  for (std::size_t j = 0; j < rod.edges(); ++j) state.x[j + 1] = state.x[j] + Vec3(rod.rest_length[j], 0, 0);
  return state;
}

State ring_state(const Rod& rod) {
  assert(rod.is_loop());
  State state = empty_state(rod);
  const double n = rod.segments, radius = rod.length / n / (2 * std::sin(pi / n));
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / n;
    state.x[i] = radius * Vec3(std::sin(angle), 1 - std::cos(angle), 0);
  }
  state.x.back() = state.x.front();
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    state.reference[j] = Vec3::UnitZ().cross(state.x[j + 1] - state.x[j]).normalized();  // m2 square to the plane
    state.theta[j] = pi * rod.half_twists * (static_cast<double>(j) + 0.5) / n;
  }
  return state;
}

State state_from(const Rod& rod, const geometry::State& ribbon_state) {
  assert(ribbon_state.r.size() == rod.nodes() && ribbon_state.q.size() == rod.edges());
  State state = empty_state(rod);
  state.time = ribbon_state.time;
  state.x = ribbon_state.r;
  state.v = ribbon_state.r_dot;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const Mat3 frame = ribbon_state.q[j].toRotationMatrix();
    const Vec3 tangent = (state.x[j + 1] - state.x[j]).normalized();
    state.reference[j] = carried(frame.col(0), frame.col(2), tangent);
  }
  // Across the seam of an odd loop the section turns by half a turn, which is no twist.
  for (std::size_t i = 0; i < rod.nodes(); ++i) {
    if (rod.hinge_length[i] == 0) continue;
    const Joined edges = joined(rod, i);
    const double turned = turn_between(state, edges) + edges.turn;
    state.reference_twist[i] = turned - 2 * pi * std::round(turned / (2 * pi)) - edges.turn;
  }
  return state;
}

}  // namespace wunderlich::baseline::rod
