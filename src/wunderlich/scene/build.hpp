/// From a checked tree to a scene: what the table of keys alone cannot say is checked here.
#pragma once

#include <map>

#include "wunderlich/scene/scene.hpp"
#include "wunderlich/scene/schema.hpp"

namespace wunderlich::scene {

/// The strip, without `clamped`, which follows from the clamps.
geometry::RibbonSpec build_ribbon(const Cell& root);

/// Clamps, pins, forces, gravity, obstacles; sets `ribbon.clamped`. Throws InputError for supports that contradict each
/// other or ask for more than the strip's length.
constraint::Surroundings build_surroundings(const Cell& root, geometry::RibbonSpec& ribbon);

/// Solids in the way of a strip of so many segments, and how it touches them.
std::vector<constraint::Obstacle> build_obstacles(const Cell& root, int segments);
constraint::Contact build_contact(const Cell& root, double width);

/// Solver options; `last_key` is the time of the last keyframe, 0 without any.
SolverOptions build_solver(const Cell& root, const geometry::RibbonSpec& ribbon, double last_key);

Method method_of(const Cell& root);

/// Where a motion starts; nothing for equilibria, which start undeformed.
InitialState build_initial(const Cell& root, const geometry::RibbonSpec& ribbon);

/// The models beside the ribbon.
CompareOptions build_compare(const Cell& root, const geometry::RibbonSpec& ribbon, const SolverOptions& solver);

/// Output options; throws InputError when they ask for more data than is sensible for this strip.
OutputOptions build_output(const Cell& root, const geometry::RibbonSpec& ribbon);

Vec3 vector(const Cell& cell);

/// What an optional number is, or what it is without being given.
double number_or(const Cell& cell, double fallback);

/// What the chosen word means.
template <typename T>
T chosen(const Cell& cell, const std::map<std::string, T>& meanings) {
  return meanings.at(text(cell));
}

/// A support with the place it was written at, for messages.
struct PlacedSupport {
  Cell cell;
  double u = 0;      ///< arc length of its node [m]
  bool end = false;  ///< a clamp of an end node's own frame
  constraint::Support support;
};

/// Throws InputError when two supports hold the same part of the strip, or stand farther apart than the strip
/// between them is long, at any time.
void check_supports(const geometry::RibbonSpec& ribbon, const std::vector<PlacedSupport>& supports);

}  // namespace wunderlich::scene
