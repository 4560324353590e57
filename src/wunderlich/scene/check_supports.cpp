#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "wunderlich/scene/build.hpp"

namespace wunderlich::scene {

namespace {

bool holds_all_axes(const constraint::Support& support) {
  return std::all_of(support.hold_position.begin(), support.hold_position.end(), [](bool hold) { return hold; });
}

/// Nodes whose position a support fixes: a clamped segment fixes both of its nodes, an end clamp one.
std::vector<int> held_nodes(const geometry::RibbonSpec& ribbon, const PlacedSupport& placed) {
  const constraint::Support& support = placed.support;
  if (placed.end || support.segment < 0) return {support.node};
  const bool loop = ribbon.closure == geometry::Closure::loop;
  const int next = support.node + 1;
  return {support.node, loop ? next % ribbon.segments : next};
}

/// Where two supports hold one node, each of them says where it is.
void check_overlap(const geometry::RibbonSpec& ribbon, const std::vector<PlacedSupport>& supports) {
  std::map<int, const PlacedSupport*> holder;
  for (const PlacedSupport& placed : supports) {
    for (const int node : held_nodes(ribbon, placed)) {
      const auto [entry, fresh] = holder.emplace(node, &placed);
      if (fresh) continue;
      fail(placed.cell, fmt::format("contradicts {} ({}): both hold node {}; keep one of them",
                                    entry->second->cell.path, described(entry->second->cell.place), node));
    }
  }
}

/// Key times of both motions. Between them both move linearly, so their distance is convex in time and is largest
/// at one of these.
std::set<double> key_times(const constraint::Motion& a, const constraint::Motion& b) {
  std::set<double> times;
  for (const auto& key : a.keys) times.insert(key.time);
  for (const auto& key : b.keys) times.insert(key.time);
  return times;
}

/// Distance along the axes that both hold; the strip can at best bridge the others for free.
double held_distance(const constraint::Support& a, const constraint::Support& b, double time) {
  Vec3 gap = pose_at(b.motion, time).position - pose_at(a.motion, time).position;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (!a.hold_position[i] || !b.hold_position[i]) gap[axis] = 0;
  }
  return gap.norm();
}

void check_reach(const geometry::RibbonSpec& ribbon, const PlacedSupport& a, const PlacedSupport& b) {
  double arc = std::abs(b.u - a.u);
  if (ribbon.closure == geometry::Closure::loop) arc = std::min(arc, ribbon.length - arc);
  constexpr double rounding = 1e-9;
  for (const double time : key_times(a.support.motion, b.support.motion)) {
    const double distance = held_distance(a.support, b.support, time);
    if (distance <= arc * (1 + rounding)) continue;
    fail(b.cell, fmt::format("is {:g} m away from {} ({}) at time {:g}, but the strip between them is {:g} m long and "
                             "does not stretch; bring them closer",
                             distance, a.cell.path, described(a.cell.place), time, arc));
  }
}

/// Neighbours along the strip suffice: the triangle inequality covers the rest.
void check_neighbours(const geometry::RibbonSpec& ribbon, const std::vector<const PlacedSupport*>& ordered) {
  if (ordered.size() < 2) return;
  for (std::size_t i = 1; i < ordered.size(); ++i) check_reach(ribbon, *ordered[i - 1], *ordered[i]);
  check_reach(ribbon, *ordered.front(), *ordered.back());
}

}  // namespace

void check_supports(const geometry::RibbonSpec& ribbon, const std::vector<PlacedSupport>& supports) {
  check_overlap(ribbon, supports);
  std::vector<const PlacedSupport*> all;
  for (const PlacedSupport& placed : supports) all.push_back(&placed);
  std::stable_sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->u < b->u; });
  check_neighbours(ribbon, all);
  // A support that slides breaks the chain of distances; those that do not must be in reach of each other anyway.
  std::vector<const PlacedSupport*> fixed;
  std::copy_if(all.begin(), all.end(), std::back_inserter(fixed),
               [](const auto* placed) { return holds_all_axes(placed->support); });
  check_neighbours(ribbon, fixed);
}

}  // namespace wunderlich::scene
