#include "wunderlich/solver/two_stage/contact_touch.hpp"

#include <algorithm>

#include "wunderlich/solver/two_stage/contact_pairs.hpp"
#include "wunderlich/solver/two_stage/contact_points.hpp"
#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

constexpr double kLeft = 0.8;        // of a depth that a step leaves
constexpr double kMostLeft = 0.005;  // of the width: no more may be left

}  // namespace

Vec3 into(const Pose& pose, const Vec3& point) { return pose.frame.conjugate() * Vec3(point - pose.position); }
Vec3 out_of(const Pose& pose, const Vec3& point) { return pose.position + pose.frame * point; }

double allowed_gap(double start_gap, double width) { return std::clamp(kLeft * start_gap, -kMostLeft * width, 0.0); }

void set_surroundings(const Ribbon& ribbon, const constraint::Surroundings& surroundings, double t0, double t1,
                      Workspace& work) {
  set_solids(ribbon, surroundings, t0, t1, work);
  set_pairs(ribbon, surroundings, work);
  work.touches.clear();
}

Nearest find_touches(const Ribbon& ribbon, const geometry::State& shape, double tolerance, Workspace& work) {
  Nearest nearest;
  find_points(ribbon, shape, tolerance, nearest, work);
  find_pairs(shape, tolerance, nearest, work);
  return nearest;
}

void refresh_touch(const geometry::State& shape, const Workspace& work, Touch& touch) {
  if (touch.pair) {
    refresh_pair(work, touch);
  } else {
    refresh_point(shape, work, touch);
  }
}

}  // namespace wunderlich::solver::two_stage
