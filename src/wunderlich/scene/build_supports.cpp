#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/scene/build.hpp"
#include "wunderlich/scene/keyframes.hpp"

namespace wunderlich::scene {

namespace {

using constraint::LoadKey;
using constraint::Orientation;
using constraint::PoseKey;
using constraint::Support;

const AxisNames clamp_axes{"tangent", "normal", "[0, 0, 1]"};

/// What the reader needs to know of the strip while it places things on it.
struct Strip {
  const geometry::RibbonSpec& spec;
  std::vector<double> node_u;
  bool loop() const { return spec.closure == geometry::Closure::loop; }
  int last_node() const { return loop() ? spec.segments - 1 : spec.segments; }
};

[[noreturn]] void fail_index(const Cell& cell, long value, int last) {
  fail(cell, fmt::format("{} is not on the strip; must be a whole number from 0 to {}", value, last));
}

double arc_length(const Cell& cell, const Strip& strip) {
  const double u = number(cell);
  if (u > strip.spec.length) {
    fail(cell, fmt::format("{:g} is beyond the strip; must be a number from 0 to {:g} m", u, strip.spec.length));
  }
  return u;
}

/// `start` and `end` name nodes of an open strip.
int end_node(const Cell& at, const Strip& strip) {
  if (strip.loop()) fail(at, "a loop has no ends; give a map such as {node: 0}");
  return text(at) == "start" ? 0 : strip.spec.segments;
}

/// The node that a pin or a force acts on.
int node_at(const Cell& at, const Strip& strip) {
  if (at.value == nullptr || at.value->kind != Value::Kind::map) return end_node(at, strip);
  const Cell node = child(at, "node");
  if (node.value != nullptr) {
    const long i = integer(node);
    if (i > strip.last_node()) fail_index(node, i, strip.last_node());
    return static_cast<int>(i);
  }
  const double u = arc_length(child(at, "u"), strip);
  const auto above = std::lower_bound(strip.node_u.begin(), strip.node_u.end() - 1, u);
  const auto below = above == strip.node_u.begin() ? above : above - 1;
  const auto nearest = u - *below < *above - u ? below : above;
  const auto index = static_cast<int>(nearest - strip.node_u.begin());
  return strip.loop() ? index % strip.spec.segments : index;
}

/// Where a clamp acts: an end node of an open strip, or a segment.
void place_clamp(const Cell& at, const Strip& strip, PlacedSupport& clamp) {
  const int last = strip.spec.segments - 1;
  const auto at_end = [&](int node) {
    clamp.support.node = node;
    clamp.end = true;
  };
  if (at.value == nullptr || at.value->kind != Value::Kind::map) {
    if (strip.loop()) fail(at, "a loop has no ends to clamp; give a map such as {segment: 0}");
    return at_end(end_node(at, strip));
  }
  long segment = 0;
  if (const Cell node = child(at, "node"); node.value != nullptr) {
    const long i = integer(node);
    if (!strip.loop() && (i == 0 || i == strip.spec.segments)) return at_end(static_cast<int>(i));
    fail(node, fmt::format("{} is no end of an open strip; a clamp inside it holds a segment, such as {{segment: {}}}",
                           i, std::min<long>(i, last)));
  } else if (const Cell u_cell = child(at, "u"); u_cell.value != nullptr) {
    const double u = arc_length(u_cell, strip);
    if (!strip.loop() && u == 0) return at_end(0);
    if (!strip.loop() && u == strip.spec.length) return at_end(strip.spec.segments);
    const auto above = std::upper_bound(strip.node_u.begin(), strip.node_u.end(), u);
    segment = std::min<long>(above - strip.node_u.begin() - 1, last);
  } else {
    segment = integer(child(at, "segment"));
    if (segment > last) fail_index(child(at, "segment"), segment, last);
  }
  clamp.support.node = static_cast<int>(segment);
  clamp.support.segment = static_cast<int>(segment);
}

std::array<bool, 3> held_axes(const Cell& free_cell) {
  std::array<bool, 3> held{true, true, true};
  for (const std::string& axis : words(free_cell)) {
    bool& hold = held[static_cast<std::size_t>(axis[0] - 'x')];
    if (!hold) fail(free_cell, "`" + axis + "` is given twice");
    hold = false;
  }
  return held;
}

constraint::Motion motion_of(const Cell& cell, const Vec3& rest_position, bool with_frame) {
  PoseKey key;
  const auto position = child(cell, "position");
  key.pose.position = position.value != nullptr ? vector(position) : rest_position;
  Axes axes{Vec3::UnitX(), Vec3::UnitZ()};
  if (with_frame) {
    axes = {direction(child(cell, "tangent")), direction(child(cell, "normal"))};
    key.pose.frame = frame_of(axes, clamp_axes, cell);
    key.turn = number(child(cell, "turn"));
  }
  return motion_from(cell, key, clamp_axes.d3, [&](const Cell& keyframe, PoseKey& next) {
    if (!with_frame) return;
    if (const Cell c = child(keyframe, "tangent"); c.value != nullptr) axes.d3 = direction(c);
    if (const Cell c = child(keyframe, "normal"); c.value != nullptr) axes.d1 = direction(c);
    if (const Cell c = child(keyframe, "turn"); c.value != nullptr) next.turn = number(c);
    next.pose.frame = frame_of(axes, clamp_axes, keyframe);
  });
}

PlacedSupport clamp_of(const Cell& cell, const Strip& strip) {
  PlacedSupport clamp;
  clamp.cell = cell;
  place_clamp(child(cell, "at"), strip, clamp);
  Support& support = clamp.support;
  clamp.u = strip.node_u[static_cast<std::size_t>(support.node)];
  support.hold_position = held_axes(child(cell, "free"));
  const bool full = text(child(cell, "orientation")) == "full";
  support.orientation = full ? Orientation::full : Orientation::about_tangent;
  support.motion = motion_of(cell, {clamp.u, 0, 0}, true);
  return clamp;
}

PlacedSupport pin_of(const Cell& cell, const Strip& strip) {
  PlacedSupport pin;
  pin.cell = cell;
  Support& support = pin.support;
  support.node = node_at(child(cell, "at"), strip);
  support.orientation = Orientation::free;
  pin.u = strip.node_u[static_cast<std::size_t>(support.node)];
  support.hold_position = held_axes(child(cell, "free"));
  if (support.hold_position == std::array<bool, 3>{})
    fail(child(cell, "free"), "a pin that is free in x, y and z holds nothing");
  support.motion = motion_of(cell, {pin.u, 0, 0}, false);
  return pin;
}

constraint::Load load_of(const Cell& cell, const Strip& strip) {
  constraint::Load load;
  load.node = node_at(child(cell, "at"), strip);
  load.frame = text(child(cell, "frame")) == "space" ? constraint::LoadFrame::space : constraint::LoadFrame::material;
  LoadKey key{0, vector(child(cell, "force")), vector(child(cell, "torque"))};
  const Cell keyframes = child(cell, "keyframes");
  for (std::size_t i = 0; i < count(keyframes); ++i) {
    const Cell keyframe = element(keyframes, i);
    key.time = next_time(keyframe, load.keys);
    if (const Cell c = child(keyframe, "force"); c.value != nullptr) key.force = vector(c);
    if (const Cell c = child(keyframe, "torque"); c.value != nullptr) key.torque = vector(c);
    load.keys.push_back(key);
  }
  if (load.keys.empty()) load.keys.push_back(key);
  const bool acts = std::any_of(load.keys.begin(), load.keys.end(),
                                [](const LoadKey& k) { return !k.force.isZero(0) || !k.torque.isZero(0); });
  if (!acts) fail(cell, "has neither a force nor a torque");
  return load;
}

}  // namespace

double number_or(const Cell& cell, double fallback) { return cell.value != nullptr ? number(cell) : fallback; }

Vec3 vector(const Cell& cell) {
  const std::vector<double> v = numbers(cell);
  return {v[0], v[1], v[2]};
}

constraint::Surroundings build_surroundings(const Cell& root, geometry::RibbonSpec& ribbon) {
  const Strip strip{ribbon, geometry::make_ribbon(ribbon).node_u};
  constraint::Surroundings surroundings;
  surroundings.gravity = vector(child(root, "gravity"));
  std::vector<PlacedSupport> placed;
  const Cell clamps = child(root, "clamps");
  for (std::size_t i = 0; i < count(clamps); ++i) placed.push_back(clamp_of(element(clamps, i), strip));
  const Cell pins = child(root, "pins");
  for (std::size_t i = 0; i < count(pins); ++i) placed.push_back(pin_of(element(pins, i), strip));
  check_supports(ribbon, placed);
  const bool moves = method_of(root) != Method::equilibrium;
  for (PlacedSupport& p : placed) {
    if (const Cell release = child(p.cell, "release"); release.value != nullptr) {
      if (!moves) fail(release, "has no effect with `method: equilibrium`");
      p.support.release = number(release);
    }
    // Held at the end itself: the half cell up to it must be able to bend.
    if (p.end) ribbon.clamped[p.support.node == 0 ? 0 : 1] = true;
    surroundings.supports.push_back(p.support);
  }
  const Cell forces = child(root, "forces");
  for (std::size_t i = 0; i < count(forces); ++i) surroundings.loads.push_back(load_of(element(forces, i), strip));
  // A torque on an end turns that end's own frame: the half cell up to it must be able to bend.
  for (const constraint::Load& load : surroundings.loads) {
    const bool turns =
        std::any_of(load.keys.begin(), load.keys.end(), [](const LoadKey& k) { return !k.torque.isZero(0); });
    const bool at_end = load.node == 0 || load.node == ribbon.segments;
    if (turns && at_end && ribbon.closure == geometry::Closure::open) ribbon.clamped[load.node == 0 ? 0 : 1] = true;
  }
  surroundings.obstacles = build_obstacles(root, ribbon.segments);
  surroundings.contact = build_contact(root, ribbon.width);
  // Contact is a projection in the two-stage method, which asks for no potential.
  const bool needs_potential = surroundings.contact.self && method_of(root) != Method::two_stage;
  for (std::size_t i = 0; i < surroundings.loads.size() && needs_potential; ++i) {
    const auto has_torque = [](const LoadKey& k) { return !k.torque.isZero(0); };
    const constraint::Load& load = surroundings.loads[i];
    const bool turns = std::any_of(load.keys.begin(), load.keys.end(), has_torque);
    if (turns || load.frame == constraint::LoadFrame::material) {
      fail(element(forces, i),
           "torques and forces that turn with the strip have no potential: with "
           "`contact.self: true` only by `solver.method: two-stage`; turn a clamp instead");
    }
  }
  if (surroundings.supports.empty() && !moves) {
    const std::string problem = "nothing holds the strip against it; add a clamp or a pin";
    if (!surroundings.loads.empty()) fail(child(root, "forces"), problem);
    if (!surroundings.gravity.isZero(0)) fail(child(root, "gravity"), problem);
  }
  return surroundings;
}

}  // namespace wunderlich::scene
