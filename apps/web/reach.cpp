#include "reach.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::web {

using constraint::Support;

namespace {

constexpr double kReach = 0.999;  // of the strip between two supports
constexpr double kWidest = 0.95;  // of the width at which rulings meet

/// The largest |w eta'/2|.
double ruling_ratio(const geometry::RibbonSpec& spec, const geometry::State& state) {
  double most = 0;
  for (const double x : geometry::strains(geometry::make_ribbon(spec), state).ruling_ratio) {
    most = std::max(most, std::abs(x));
  }
  return most;
}

/// Of the strip between two nodes [m].
double reach_between(const scene::Scene& strip, int a, int b) {
  return kReach * strip.ribbon.length / strip.ribbon.segments * std::abs(a - b);
}

/// The smallest factor on the length by which the strip still reaches from support to support.
double least_length(const scene::Scene& strip, double time) {
  double least = 0;
  const auto& supports = strip.surroundings.supports;
  for (std::size_t i = 0; i < supports.size(); ++i) {
    for (std::size_t k = i + 1; k < supports.size(); ++k) {
      if (supports[i].node == supports[k].node || time >= std::min(supports[i].release, supports[k].release)) continue;
      Vec3 between = constraint::pose_at(supports[k].motion, time).position -
                     constraint::pose_at(supports[i].motion, time).position;
      for (int c = 0; c < 3; ++c) {
        const auto axis = static_cast<std::size_t>(c);
        if (!supports[i].hold_position[axis] || !supports[k].hold_position[axis]) between[c] = 0;
      }
      least = std::max(least, between.norm() / reach_between(strip, supports[i].node, supports[k].node));
    }
  }
  return least;
}

}  // namespace

Vec3 within(const Vec3& v, double most) {
  const double norm = v.norm();
  return norm > most ? Vec3(v * (most / norm)) : v;
}

Vec3 reachable(Vec3 point, std::size_t support, const scene::Scene& strip, double time) {
  const auto& supports = strip.surroundings.supports;
  if (strip.ribbon.closure == geometry::Closure::loop) return point;
  for (std::size_t k = 0; k < supports.size(); ++k) {
    if (k == support) continue;
    const Vec3 other = constraint::pose_at(supports[k].motion, time).position;
    point = other + within(point - other, reach_between(strip, supports[k].node, supports[support].node));
  }
  return point;
}

std::string limit(Scale& scale, const scene::Scene& strip, const geometry::State& state, double time) {
  std::string why;
  const double ratio = ruling_ratio(strip.ribbon, state);
  const double most = ratio > 0 ? std::max(1.0, kWidest / ratio) : INFINITY;  // of the width's factor over the length's
  if (scale.width > most * scale.length) {
    why = scale.width > 1 ? "the strip cannot be wider in this shape: rulings would meet"
                          : "the strip cannot be shorter in this shape: rulings would meet";
    if (scale.width > 1) scale.width = std::max(1.0, most * scale.length);
    scale.length = std::max(scale.length, scale.width / most);
  }
  const double least = std::min(1.0, least_length(strip, time));
  if (scale.length < least) {
    why = "the strip cannot be shorter: its supports are as far apart";
    scale.length = least;
  }
  return why;
}

}  // namespace wunderlich::web
