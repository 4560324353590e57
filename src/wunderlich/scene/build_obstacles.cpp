#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/scene/build.hpp"
#include "wunderlich/scene/keyframes.hpp"
#include "wunderlich/scene/mesh_text.hpp"

namespace wunderlich::scene {

namespace {

using constraint::Obstacle;

constexpr std::size_t kMostPairs = 20000;  // of obstacles and segments: half a gigabyte of points

const AxisNames box_axes{"axis", "side", "[1, 0, 0]"};

/// Keys that only some shapes read; given with another they are a mistake worth telling.
void check_use(const Cell& cell, const std::string& shape) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> own{
      {"radius", {"sphere", "cylinder", "capsule"}},
      {"length", {"cylinder", "capsule"}},
      {"size", {"box"}},
      {"side", {"box", "mesh"}},
      {"file", {"mesh"}},
      {"obj", {"mesh"}},
      {"scale", {"mesh"}},
      {"normal", {"plane"}},
      {"axis", {"sphere", "cylinder", "capsule", "box", "mesh"}}};
  for (const auto& [name, shapes] : own) {
    if (std::find(shapes.begin(), shapes.end(), shape) != shapes.end()) continue;
    const Cell given = child(cell, name);
    if (given.value != nullptr) fail(given, "has no effect with `shape: " + shape + "`");
  }
}

contact::Polyhedron mesh_of(const Cell& cell) {
  const Cell obj = child(cell, "obj");
  if (obj.value == nullptr) fail(child(cell, "file"), "is missing; must be the path of an OBJ file, or `obj` its text");
  const std::string source = fmt::format("{}: {}", described(obj.place), obj.path);
  return {
      std::make_shared<const contact::TriangleMesh>(mesh_from_obj(text(obj), source, number(child(cell, "scale"))))};
}

contact::Shape shape_of(const Cell& cell, const std::string& shape) {
  if (shape == "plane") return contact::HalfSpace{};
  if (shape == "box") return contact::Box{0.5 * vector(child(cell, "size"))};
  if (shape == "mesh") return mesh_of(cell);
  const double radius = number(child(cell, "radius"));
  if (shape == "sphere") return contact::Sphere{radius};
  const Cell length = child(cell, "length");
  const bool endless = shape == "cylinder" && length.value == nullptr;
  const double half_length = endless ? std::numeric_limits<double>::infinity() : 0.5 * number(length);
  if (shape == "cylinder") return contact::Cylinder{radius, half_length};
  return contact::Capsule{radius, half_length};
}

/// How a body stands. Starts with the table's defaults.
struct Stand {
  Axes axes{Vec3::UnitZ(), Vec3::UnitX()};
  Quat frame = Quat::Identity();
};

std::string axis_name(const std::string& shape) { return shape == "plane" ? "normal" : "axis"; }

/// Turns a body to the directions that it or one of its keyframes gives; others stay as they were.
void turn_to(const Cell& cell, const std::string& shape, Stand& stand) {
  check_use(cell, shape);
  const Vec3 before = stand.axes.d3;
  if (const Cell c = child(cell, axis_name(shape)); c.value != nullptr) stand.axes.d3 = direction(c);
  if (const Cell c = child(cell, "side"); c.value != nullptr) stand.axes.d1 = direction(c);
  // A round body has no sides to tell: it goes the shortest way, without a turn about its axis.
  stand.frame = shape == "box" || shape == "mesh" ? frame_of(stand.axes, box_axes, cell)
                                                  : math::shortest_rotation(before, stand.axes.d3) * stand.frame;
}

constraint::Motion motion_of(const Cell& cell, const std::string& shape) {
  Stand stand;
  turn_to(cell, shape, stand);
  constraint::PoseKey key;
  key.pose = {vector(child(cell, "position")), stand.frame};
  key.turn = number(child(cell, "turn"));
  return motion_from(cell, key, axis_name(shape), [&](const Cell& keyframe, constraint::PoseKey& next) {
    if (const Cell c = child(keyframe, "turn"); c.value != nullptr) next.turn = number(c);
    turn_to(keyframe, shape, stand);
    next.pose.frame = stand.frame;
  });
}

Obstacle obstacle_of(const Cell& cell, const Cell& contact) {
  const std::string shape = text(child(cell, "shape"));
  Obstacle obstacle;
  obstacle.motion = motion_of(cell, shape);
  obstacle.shape = shape_of(cell, shape);
  const Cell friction = child(cell, "friction");
  obstacle.friction = number(friction.value != nullptr ? friction : child(contact, "friction"));
  return obstacle;
}

}  // namespace

std::vector<Obstacle> build_obstacles(const Cell& root, int segments) {
  const Cell list = child(root, "obstacles");
  const std::size_t pairs = count(list) * static_cast<std::size_t>(segments);
  if (pairs > kMostPairs) {
    fail(list, fmt::format("{} pairs of obstacles and segments; at most {} fit into memory", pairs, kMostPairs));
  }
  const bool equilibrium = method_of(root) == Method::equilibrium;
  std::vector<Obstacle> obstacles;
  for (std::size_t i = 0; i < count(list); ++i) {
    obstacles.push_back(obstacle_of(element(list, i), child(root, "contact")));
    if (equilibrium && obstacles.back().friction > 0) {
      fail(element(list, i), "friction has no effect with `solver.method: equilibrium`; use `implicit` or `two-stage`");
    }
  }
  return obstacles;
}

constraint::Contact build_contact(const Cell& root, double width) {
  const Cell cell = child(root, "contact");
  const Cell self = child(cell, "self");
  if (cell.value != nullptr && count(child(root, "obstacles")) == 0 && !boolean(self)) {
    fail(cell, "has no effect without `obstacles` or `contact.self: true`");
  }
  const Cell friction = child(cell, "friction");
  if (boolean(self) && number(friction) > 0 && method_of(root) == Method::equilibrium) {
    fail(friction, "has no effect with `solver.method: equilibrium`; use `implicit` or `two-stage`");
  }
  const Cell distance = child(cell, "distance");
  return {distance.value != nullptr ? number(distance) : width / 30, number(child(cell, "thickness")), boolean(self),
          number(friction)};
}

}  // namespace wunderlich::scene
