#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "wunderlich/scene/compare_models.hpp"

namespace wunderlich::scene {

Scene with_segments(const Scene& scene, int segments) {
  Scene out = scene;
  if (segments == scene.ribbon.segments) return out;
  out.ribbon.segments = segments;
  out.ribbon.spacing.clear();
  const std::vector<double> before = geometry::make_ribbon(scene.ribbon).node_u;
  const std::vector<double> after = geometry::make_ribbon(out.ribbon).node_u;
  const bool loop = scene.ribbon.closure == geometry::Closure::loop;
  const auto nearest = [&](int node) {
    const double u = before[static_cast<std::size_t>(node)];
    const auto by_distance = [&](double a, double b) { return std::abs(a - u) < std::abs(b - u); };
    const auto at = static_cast<int>(std::min_element(after.begin(), after.end(), by_distance) - after.begin());
    return loop ? at % segments : at;
  };
  for (constraint::Support& support : out.surroundings.supports) {
    support.node = nearest(support.node);
    if (support.segment >= 0) support.segment = support.node = std::min(support.node, segments - 1);
  }
  for (constraint::Load& load : out.surroundings.loads) load.node = nearest(load.node);
  return out;
}

double largest_shift(const Scene& scene, const Scene& other) {
  const std::vector<double> before = geometry::make_ribbon(scene.ribbon).node_u;
  const std::vector<double> after = geometry::make_ribbon(other.ribbon).node_u;
  double most = 0;
  const auto look_at = [&](int from, int to) {
    const double way = std::abs(before[static_cast<std::size_t>(from)] - after[static_cast<std::size_t>(to)]);
    const bool loop = scene.ribbon.closure == geometry::Closure::loop;
    most = std::max(most, loop ? std::min(way, scene.ribbon.length - way) : way);
  };
  const constraint::Surroundings &a = scene.surroundings, &b = other.surroundings;
  for (std::size_t i = 0; i < a.supports.size(); ++i) look_at(a.supports[i].node, b.supports[i].node);
  for (std::size_t i = 0; i < a.loads.size(); ++i) look_at(a.loads[i].node, b.loads[i].node);
  return most;
}

std::string fallen_together(const Scene& scene, const Scene& other) {
  const auto& before = scene.surroundings.supports;
  const auto& after = other.surroundings.supports;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (before[i].node == before[k].node || after[i].node != after[k].node) continue;
      return fmt::format("supports at nodes {} and {} of the ribbon fall on one of its own: it needs more segments",
                         before[k].node, before[i].node);
    }
  }
  return "";
}

}  // namespace wunderlich::scene
