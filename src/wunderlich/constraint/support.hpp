/// What the surroundings prescribe: pins, clamps, orientation constraints, loads and obstacles, in time.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/contact/shape.hpp"

namespace wunderlich::constraint {

/// One key of a prescribed motion. `turn` is a further rotation about d3 that may exceed a full turn,
/// which a frame alone cannot say.
struct PoseKey {
  double time = 0;  ///< [s]; the load parameter of an equilibrium path
  Pose pose;
  double turn = 0;  ///< about d3, right-handed [rad]
};

/// Keys in increasing time; constant before the first and after the last, in between positions and turns
/// linearly, frames along the shorter rotation.
struct Motion {
  std::vector<PoseKey> keys;
};

/// Where a motion is at a time, its turn included, and the time of its last key.
Pose pose_at(const Motion& motion, double time);
double end_time(const Motion& motion);

/// Instead: from where it is at time `now` evenly to `target`, whose time is later, and there it stays.
void move_to(const PoseKey& target, double now, Motion& motion);

/// Which rotations a support holds.
enum class Orientation {
  free,           ///< a pin
  about_tangent,  ///< the paper's orientation constraint: rotation about the centerline only   @eq Shen2015:18
  full,           ///< a clamp
};

/// A support at a node or a segment. At an end node of an open strip the node's own frame is held (half-cell hinge);
/// anywhere else the frame is that of the segment and the position that of its first node.
struct Support {
  int node = 0;                                         ///< node whose position is held; for a segment its first node
  int segment = -1;                                     ///< segment whose frame is held, -1: the end node's own frame
  std::array<bool, 3> hold_position{true, true, true};  ///< world x, y, z
  Orientation orientation = Orientation::full;
  Motion motion;
  double release = std::numeric_limits<double>::infinity();  ///< when it lets go [s]; dynamics only
};

/// Whether a load keeps its direction in space or turns with the material frame it acts on.
enum class LoadFrame { space, material };

struct LoadKey {
  double time = 0;
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]
};

/// A force and torque at a node, linear in time between keys.
struct Load {
  int node = 0;
  LoadFrame frame = LoadFrame::space;
  std::vector<LoadKey> keys;
};

/// Force and torque of a load at a time; `time` of the result is that time.
LoadKey load_at(const Load& load, double time);

/// A solid that the strip cannot enter, at rest or moving; its own frame follows `motion`.
struct Obstacle {
  contact::Shape shape;
  Motion motion;
  double friction = 0;  ///< Coulomb's coefficient
};

/// How the strip and the obstacles touch.
struct Contact {
  double distance = 0;   ///< at which forces begin [m]
  double thickness = 0;  ///< gap that stays between the strip's middle surface and a solid, or itself [m]
  bool self = false;     ///< does the strip feel itself
  double friction = 0;   ///< Coulomb's coefficient of the strip on itself
};

/// A spring between the middle of a segment and a point, and between its directions and those of a frame: a hand.
struct Grip {
  int segment = 0;
  double stiffness = 0;       ///< of the middle [N/m]
  double turn_stiffness = 0;  ///< of each of d2 and d3 [N m]
  Pose target;
};

/// Everything imposed from outside.
struct Surroundings {
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<Grip> grips;
  std::vector<Obstacle> obstacles;
  Contact contact;
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
};

}  // namespace wunderlich::constraint
