// Strips that fall on solids with edges: they stay out, rest on their weight, and no step carries them through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "implicit/drops.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

const Vec3 kDown(0, 0, -kGravity);

/// A ball of triangles: those of an icosahedron, each cut into four `times` over.
contact::Shape ball(double radius, int times) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> vertices{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<int, 3>> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int pass = 0; pass < times; ++pass) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
      if (is_new) vertices.push_back(vertices[static_cast<std::size_t>(a)] + vertices[static_cast<std::size_t>(b)]);
      return place->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(t);
    }
    triangles = finer;
    for (Vec3& v : vertices) v.normalize();
  }
  for (Vec3& v : vertices) v = radius * v.normalized();
  EXPECT_EQ(contact::find_fault(vertices, triangles).fault, contact::MeshFault::none);
  return contact::Polyhedron{std::make_shared<const contact::TriangleMesh>(contact::make_mesh(vertices, triangles))};
}

TEST(MeshContact, ADrapeOverABallOfTrianglesStaysOut) {
  for (const double dt : {5e-3, 1e-2}) {
    if (is_slow_build() && dt < 1e-2) continue;
    Motion m =
        drop(2e-5, 20, {solid(ball(0.05, 2), {Vec3(0.15, 0.004, -0.07), Quat::Identity()})}, along_x(0, 0), kDown);
    const double least = lowest_clearance(is_slow_build() ? 0.1 : 0.3, dt, m, 6);
    show("smallest distance to a ball of 320 triangles", least, 0);
    EXPECT_GT(least, 0);
    EXPECT_LT(least, 1e-3);  // it got there
  }
}

/// Over the edge of a box, aslant, and over its corner.
TEST(MeshContact, ADrapeOverAnEdgeStaysOut) {
  for (const Vec3& place : {Vec3(0.05, 0, -0.06), Vec3(0.03, -0.06, -0.06)}) {
    for (const double dt : {2e-3, 1e-2}) {
      if (is_slow_build() && dt < 1e-2) continue;
      const Pose pose{place, math::exp_map(Vec3(0, 0, 0.5))};
      Motion m = drop(2e-5, 20, {solid(contact::Box{{0.08, 0.06, 0.05}}, pose)}, along_x(0, 0), kDown);
      const double least = lowest_clearance(is_slow_build() ? 0.15 : 0.4, dt, m);
      show("smallest distance to a box", least, 0);
      EXPECT_GT(least, 0);
      EXPECT_LT(least, 1e-3);
      EXPECT_LT(implicit::shape_of(m.path, m.state).r.back().z(), -0.05);  // it hangs over
    }
  }
}

TEST(MeshContact, ReactionIsTheWeight) {
  const constraint::Obstacle table = solid(contact::Box{{0.4, 0.3, 0.01}}, {Vec3(0.15, 0.02, -0.01), Quat::Identity()});
  Motion m = drop(1e-2, 20, {table}, along_x(0, 9.5e-4), kDown);
  m.options.integrator = implicit::Integrator::euler;
  start(geometry::straight_chain(m.path.ribbon, along_x(0, 9.5e-4)), m);
  for (int i = 1; i <= 400; ++i) ASSERT_TRUE(move_to(5e-3 * i, m)) << m.failure;
  const Vec3 push = push_of(m.path, m.state.strips[0].path.t, m.state.strips[0].path.chain);
  const double weight = 0.3 * 0.03 * 0.1 * kGravity;
  show("reaction of a box over weight, less 1", std::abs(push.z() / weight - 1), 1e-6);
  EXPECT_NEAR(push.z() / weight, 1, 1e-6);
  EXPECT_LT(push.head<2>().norm() / weight, 1e-6);
}

/// Speed down a box's top that leans by atan(slope), after 0.3 s.
double slide(double slope, double friction) {
  const double alpha = std::atan(slope);
  constraint::Obstacle table =
      solid(contact::Box{{2, 2, 0.01}}, {Vec3(0.1, 0.3, -0.01), math::exp_map(Vec3(0, 0, 0.3))});
  table.friction = friction;
  const Vec3 down = Vec3(1, 1, 0).normalized();
  Motion m =
      drop(1e-2, 8, {table}, along_x(0, 9e-4), kGravity * (std::sin(alpha) * down - std::cos(alpha) * Vec3::UnitZ()));
  m.options.integrator = implicit::Integrator::euler;
  const double dt = 2.5e-3;
  for (int i = 1; i <= 120; ++i) EXPECT_TRUE(move_to(dt * i, m)) << m.failure;
  return implicit::shape_of(m.path, m.state).r_dot[4].dot(down);
}

TEST(MeshContact, AStripSlipsOnABoxAsCoulombSays) {
  const double friction = 0.3, alpha = std::atan(1.5 * friction);
  const double held = slide(0.98 * friction, friction), steeper = slide(1.5 * friction, friction);
  show("creep on a box below the threshold [m/s]", held, 1e-3);
  EXPECT_LT(held, 1e-3);
  const double free = 0.3 * kGravity * (std::sin(alpha) - friction * std::cos(alpha));
  EXPECT_NEAR(steeper, free, 0.03 * free);
}

/// Against a thin bar, at a speed that goes 20 thicknesses in a step; its edge first.
TEST(MeshContact, NothingIsLeaptOver) {
  if (is_slow_build()) GTEST_SKIP() << "takes a minute there";
  const Pose pose{Vec3(0.15, 0, -0.1), math::exp_map(Vec3(0, 0.4, 0))};
  Motion m = drop(1e-3, 20, {solid(contact::Box{{1e-3, 1, 1e-3}}, pose)}, along_x(0, 0), Vec3::Zero());
  geometry::State shape = geometry::state_of(m.path.ribbon, m.state.strips[0].path.chain, 0);
  for (Vec3& v : shape.r_dot) v = Vec3(0, 0, -8);
  start(shape, Vec3::Zero(), m);
  const double least = lowest_clearance(0.04, 5e-3, m);
  EXPECT_GT(least, 0);
  double top = -1, bottom = 1;
  for (const Vec3& r : implicit::shape_of(m.path, m.state).r) {
    top = std::max(top, r.z());
    bottom = std::min(bottom, r.z());
  }
  EXPECT_GT(top, -0.1);  // it hangs over the bar ...
  EXPECT_LT(bottom, -0.2);
}

TEST(MeshContact, AMovingBoxPushes) {
  constraint::Obstacle wall = solid(contact::Box{{0.05, 0.05, 0.05}}, {Vec3(0.15, 0, -0.06), Quat::Identity()});
  wall.motion.keys.push_back({0.1, {Vec3(0.15, 0, 0.06), math::exp_map(Vec3(0, 0.4, 0))}, 0});
  Motion m = drop(1e-3, 20, {wall}, along_x(0, 0), Vec3::Zero());
  const double least = lowest_clearance(0.12, 2e-3, m);
  EXPECT_GT(least, 0);
  EXPECT_GT(implicit::shape_of(m.path, m.state).r[10].z(), 0.1);
}

}  // namespace
}  // namespace wunderlich::testing
