#include "implicit/drops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/paths.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_contact.hpp"

namespace wunderlich::testing {

Motion drop(double bending_stiffness, int segments, const std::vector<constraint::Obstacle>& solids, const Pose& base,
            const Vec3& gravity) {
  geometry::RibbonSpec spec = sheet(bending_stiffness, false);
  spec.segments = segments;
  constraint::Surroundings surroundings;
  surroundings.gravity = gravity;
  surroundings.obstacles = solids;
  surroundings.contact.distance = spec.width / 30;
  Motion m = make_motion(spec, surroundings);
  start(geometry::straight_chain(m.path.ribbon, base), m);
  return m;
}

constraint::Obstacle solid(const contact::Shape& shape, const Pose& pose) {
  constraint::Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.motion.keys = {{0, pose, 0}};
  return obstacle;
}

Pose along_x(double x, double z) { return {Vec3(x, 0, z), straight_frame()}; }
Pose axis_y(double x, double z, double turn) {
  return {Vec3(x, 0, z), math::exp_map(Vec3(0, 0, turn)) * math::exp_map(Vec3(-std::acos(0.0), 0, 0))};
}

double clearance(const Motion& m, int fine) {
  const geometry::State shape = implicit::shape_of(m.path, m.state);
  const geometry::Ribbon& ribbon = m.path.ribbon;
  double least = 1e9;
  for (std::size_t s = 0; s < shape.q.size(); ++s) {
    const Mat3 frame = shape.q[s].toRotationMatrix();
    const auto corner = [&](std::size_t node, double v) -> Vec3 {
      return shape.r[node] + v * (frame.col(1) + shape.eta[node] * frame.col(2));
    };
    for (int i = 0; i <= fine; ++i) {
      for (int k = 0; k <= fine; ++k) {
        const double f = static_cast<double>(i) / fine, v = ribbon.width * (static_cast<double>(k) / fine - 0.5);
        const Vec3 at = (1 - f) * corner(s, v) + f * corner(s + 1, v);
        for (const auto& obstacle : m.path.surroundings.obstacles) {
          const Pose pose = constraint::pose_at(obstacle.motion, m.state.strips[0].path.t);
          least = std::min(least, contact::distance(obstacle.shape, pose, at).value);
        }
      }
    }
  }
  return least;
}

double lowest_clearance(double duration, double dt, Motion& m, int fine) {
  double least = clearance(m, fine);
  const long steps = std::lround(duration / dt);
  for (long i = 1; i <= steps; ++i) {
    EXPECT_TRUE(move_to(static_cast<double>(i) * dt, m)) << m.failure << " at " << m.state.strips[0].path.t;
    if (m.state.strips[0].path.t < (static_cast<double>(i) - 0.5) * dt) break;
    least = std::min(least, clearance(m, fine));
  }
  return least;
}

Vec3 push_of(const solver::PathProblem& path, double t, const geometry::Chain& chain) {
  solver::ContactProblem contact;
  solver::place_solids(path.ribbon, path.surroundings, t, contact);
  geometry::Kinematics k;
  geometry::forward_kinematics(path.ribbon, chain, k);
  solver::ContactPoints points;
  solver::find_points(path.ribbon, contact, chain, k, points);
  math::ChainSystem system;
  solver::add_contact(path.ribbon, contact, chain, k, points, system);
  Vec3 push = Vec3::Zero();
  for (const math::SurfaceTerm& term : system.surfaces) push -= term.gradient.head<3>();
  return push;
}

}  // namespace wunderlich::testing
