// Contact of the strip with itself and with solids of triangles in the two-stage method: rows of pairs against finite
// differences, and strips that fall, rest, slide and fold, looked at apart from the solver's own search.
// @eq Shen2015:6.3
#include <gtest/gtest.h>

#include <cmath>

#include "support/clearance.hpp"
#include "two_stage/drops.hpp"
#include "wunderlich/contact/triangle_mesh.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/contact_solve.hpp"

namespace wunderlich::testing {
namespace {

using contact::PairKind;
using two_stage::Pair;
using two_stage::Projection;
using two_stage::Row;
using two_stage::Touch;

constexpr double kPi = 3.14159265358979323846;

contact::Shape mesh_box(const Vec3& half_size) {
  return contact::Polyhedron{std::make_shared<contact::TriangleMesh>(contact::mesh_of({half_size}))};
}

/// A ball of 8 stacks and 12 slices: triangles, no quadrilaterals.
contact::Shape mesh_ball(double radius) {
  constexpr int kStacks = 8, kSlices = 12;
  std::vector<Vec3> vertices{Vec3(0, 0, radius)};
  for (int i = 1; i < kStacks; ++i) {
    for (int k = 0; k < kSlices; ++k) {
      const double theta = kPi * i / kStacks, phi = 2 * kPi * k / kSlices;
      vertices.push_back(radius *
                         Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  vertices.emplace_back(0, 0, -radius);
  const int last = static_cast<int>(vertices.size()) - 1;
  const auto at = [&](int i, int k) { return i == 0 ? 0 : i == kStacks ? last : 1 + (i - 1) * kSlices + k % kSlices; };
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < kStacks; ++i) {
    for (int k = 0; k < kSlices; ++k) {
      if (i > 0) triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
      if (i + 1 < kStacks) triangles.push_back({at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return contact::Polyhedron{
      std::make_shared<contact::TriangleMesh>(contact::make_mesh(std::move(vertices), std::move(triangles)))};
}

/// The slope of a pair's gap, at random states, with the strip as first part, as second, and as both.
TEST(TwoStagePairs, RowsAreDerivatives) {
  std::mt19937 random(21);
  for (const NamedRibbon& sample : sample_ribbons()) {
    SCOPED_TRACE(sample.name);
    Loose l = loose(sample.ribbon, random);
    const double size = l.ribbon.rest_length.front();
    constraint::Surroundings surroundings;
    const Vec3 half = size * Vec3(0.3, 0.4, 0.5);
    const Quat frame = math::exp_map(Vec3(0.3, -0.7, 0.4));
    surroundings.obstacles = {solid(mesh_box(half), {l.shape.r[1] + size * Vec3(3, 4, -5), frame}, 0.3)};
    surroundings.contact.self = true;
    surroundings.contact.distance = 1e-3 * size;
    surroundings.contact.friction = 0.3;
    two_stage::set_surroundings(l.ribbon, surroundings, 0, 0, l.work);
    ASSERT_TRUE(two_stage::assemble_equations(l.ribbon, l.options, l.shape, l.work));
    const double h = 1e-6;
    const geometry::State plus = moved(h, l), minus = moved(-h, l);
    const int last = 2 * (l.ribbon.segments - 1);
    const std::array<int, 4> none{-1, -1, -1, -1};
    const std::vector<std::pair<Pair, std::size_t>> pairs{
        {{PairKind::vertex_triangle, {0, -1, -1, -1}, {-1, 0, 1, 2}}, 0},
        {{PairKind::vertex_triangle, {-1, 2, 3, 5}, {4, -1, -1, -1}}, 0},
        {{PairKind::edge_edge, {last, last + 2, -1, -1}, {-1, -1, 2, 3}}, 0},
        {{PairKind::vertex_triangle, {1, last, last + 1, last + 3}, none}, two_stage::kItself},
        {{PairKind::edge_edge, {0, 2, last + 1, last + 3}, none}, two_stage::kItself}};
    for (const auto& [pair, of] : pairs) {
      Touch touch;
      touch.pair = pair;
      touch.solid = of;
      const auto gap = [&](const geometry::State& shape, Touch& at) {
        two_stage::find_touches(l.ribbon, shape, 0, l.work);
        two_stage::refresh_touch(shape, l.work, at);
        return at.gap;
      };
      gap(l.shape, touch);
      Touch high = touch, low = touch;
      const double slope = (gap(plus, high) - gap(minus, low)) / (2 * h);
      Row row;
      two_stage::touch_row(l.ribbon, l.shape, touch, touch.normal, true, l.work, row);
      EXPECT_NEAR(along(row, l.motion), slope, 1e-5 * size);
      EXPECT_GT(row.slope.cwiseAbs().maxCoeff(), 0.1);
      double whole = 0;
      Vec3 way = Vec3::Zero(), arms = Vec3::Zero();
      for (const two_stage::Arm& arm : touch.arms()) {
        way += arm.weight * (two_stage::material_place(plus, arm.place, arm.eta_start) -
                             two_stage::material_place(minus, arm.place, arm.eta_start));
        arms += arm.weight * two_stage::place_of(l.shape, arm.place);
        whole += arm.weight;
      }
      // A solid pushes outward on one point; what the strip does to itself adds up to nothing.
      EXPECT_NEAR(whole, of == two_stage::kItself ? 0 : 1, 1e-12);
      const Vec3 direction = Vec3(0.3, -0.5, 0.8).normalized();
      two_stage::touch_row(l.ribbon, l.shape, touch, direction, false, l.work, row);
      EXPECT_NEAR(along(row, l.motion), direction.dot(way) / (2 * h), 1e-5 * size);
      EXPECT_LT((touch.from - arms).norm(), 1e-12 * (1 + arms.norm()));  // nothing has moved since the start
    }
  }
}

TEST(TwoStagePairs, DrapesOnMeshesStayOut) {
  const Pose box{Vec3(0.15, 0, -0.05), math::exp_map(Vec3(0, 0, 0.4)) * math::exp_map(Vec3(0.5, 0.3, 0))};
  const std::vector<constraint::Obstacle> solids{
      solid(mesh_ball(0.04), {Vec3(0.14, 0.003, -0.045), Quat::Identity()}, 0.3),
      solid(mesh_box(Vec3(0.03, 0.04, 0.02)), box, 0.3)};
  for (const constraint::Obstacle& mesh : solids) {
    Drop d = drop(2e-5, 16, {mesh}, {0, 0, -kGravity});
    const two_stage::StepReport report = go(0.25, 2e-3, 25, d);
    show("penetration of a drape over the width", -d.nearest / kWidth, 0.01);
    std::printf("  touching at most %d, halvings %d\n", d.most_touching, d.halvings);
    EXPECT_GT(d.nearest, -0.01 * kWidth);
    EXPECT_LT(d.nearest, kWidth / 30);
    EXPECT_LT(report.constraints.max_length_error, 1e-6);
    EXPECT_LT(report.constraints.max_torsion_mismatch, 1e-6);
  }
}

/// A floor of triangles, its top in the plane z = 0.
constraint::Obstacle floor_of_triangles(double friction) {
  return solid(mesh_box(Vec3(1, 0.8, 0.1)), {Vec3(0.1, 0.05, -0.1), Quat::Identity()}, friction);
}

TEST(TwoStagePairs, ReactionOfAMeshIsTheWeight) {
  for (const Projection projection : {Projection::direct, Projection::gauss_seidel}) {
    Drop d = drop(1e-3, 8, {floor_of_triangles(0.3)}, {0, 0, -kGravity});
    d.c.options.opt.projection = projection;
    place({Vec3(0, 0, 3e-4), Quat::Identity()}, d);
    const two_stage::StepReport report = go(0.04, 5e-4, 10, d);
    const double weight = 0.3 * kWidth * 0.1 * kGravity;
    show("reaction of a mesh over weight, less 1", std::abs(report.push.z() / weight - 1), 1e-6);
    EXPECT_NEAR(report.push.z() / weight, 1, 1e-6);
    EXPECT_LT(report.push.head<2>().norm() / weight, 1e-6);
  }
}

TEST(TwoStagePairs, ThicknessIsKeptFromAMesh) {
  Drop d = drop(1e-3, 8, {floor_of_triangles(0)}, {0, 0, -kGravity});
  d.surroundings.contact.thickness = 2e-3;
  place({Vec3(0, 0, 2.6e-3), Quat::Identity()}, d);
  go(0.04, 5e-4, 5, d);
  EXPECT_NEAR(d.c.state.shape.r[4].z(), 2e-3 + 0.25 * kWidth / 30, 2e-5);
  EXPECT_GT(d.nearest, 0);
}

TEST(TwoStagePairs, AStripSlipsOnAMeshAsCoulombSays) {
  constexpr double kFriction = 0.3, kTime = 0.05;
  for (const double ratio : {0.99, 1.01, 1.5}) {
    const double alpha = std::atan(ratio * kFriction);
    const Vec3 down = Vec3(1, 1, 0).normalized();
    Drop d = drop(1e-3, 8, {floor_of_triangles(kFriction)},
                  kGravity * (std::sin(alpha) * down - std::cos(alpha) * Vec3::UnitZ()));
    place({Vec3(0, 0, 0.25 * kWidth / 30), Quat::Identity()}, d);
    go(kTime, 5e-4, 50, d);
    const double speed = d.c.state.shape.r_dot[4].dot(down);
    const double free = kTime * kGravity * (std::sin(alpha) - kFriction * std::cos(alpha));
    std::printf("  tan(alpha)/mu %.2f: %.4g m/s, Coulomb %.4g\n", ratio, speed, std::max(0.0, free));
    EXPECT_NEAR(speed, std::max(0.0, free), 0.02 * std::abs(free) + 1e-7);
  }
}

/// A bar of 2 mm, its edge in the way of a strip at 8 m/s.
TEST(TwoStagePairs, NoMeshIsLeaptOver) {
  const Pose pose{Vec3(0.15, 0, -0.1), math::exp_map(Vec3(0, 0.7, 0))};
  Drop d = drop(2e-5, 12, {solid(mesh_box(Vec3(1e-3, 0.1, 1e-3)), pose)}, Vec3::Zero());
  for (Vec3& v : d.c.state.shape.r_dot) v = Vec3(0, 0, -8);
  go(0.03, 1e-3, 1, d);
  EXPECT_GT(d.nearest, -0.01 * kWidth);
  EXPECT_GT(d.c.state.shape.r[6].z(), -0.12);  // it hangs over the bar ...
  EXPECT_LT(d.c.state.shape.r[0].z(), -0.15);
}

/// A soft strip that falls on end on a floor.
Drop heap(const constraint::Obstacle& floor, bool feels_itself) {
  Drop d = drop(3e-5, 20, {floor}, {0, 0, -kGravity});
  d.surroundings.contact.self = feels_itself;
  d.surroundings.contact.friction = 0.3;
  place({Vec3(0, 0, 0.33), math::exp_map(Vec3(0.05, 0.5 * kPi - 0.1, 0))}, d);
  return d;
}

TEST(TwoStagePairs, AHeapNowhereGoesThroughItself) {
  const constraint::Obstacle plane = solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, 0.3);
  for (const constraint::Obstacle& floor : {plane, floor_of_triangles(0.3)}) {
    Drop d = heap(floor, true);
    go(0.45, 2e-3, 3, d);
    std::printf("  touching at most %d, halvings %d\n", d.most_touching, d.halvings);
    EXPECT_EQ(d.crossings, 0);
    EXPECT_GT(d.nearest, -0.01 * kWidth);
  }
  Drop loose = heap(plane, false);
  go(0.45, 2e-3, 3, loose);
  EXPECT_GT(loose.crossings, 0);  // it would
}

TEST(TwoStagePairs, ThicknessIsKeptFromItself) {
  Drop d = heap(solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, 0.3), true);
  const double thickness = d.surroundings.contact.thickness = 1e-3, distance = d.surroundings.contact.distance;
  double least = 1;
  for (int k = 0; k < 45; ++k) {
    go(1e-2, 2e-3, 5, d);
    geometry::Chain chain;
    geometry::Kinematics kinematics;
    const solver::StripPlace place = placed(d, chain, kinematics);
    least = std::min(least, clearance({&place, 1}, 3 * (distance + thickness)));
  }
  std::printf("  nearest to itself %.4f mm\n", 1e3 * least);
  EXPECT_GT(least, thickness);
  EXPECT_LT(least, thickness + distance);  // it got there
  EXPECT_EQ(d.crossings, 0);
}

/// How the pairs of a heap rub: how many stick and slide, how much more one pulls than Coulomb says, and how far off
/// the pull is where it slides, both over Coulomb's.
struct Rubbing {
  int sticking = 0, sliding = 0;
  double over = -1, off = 0;
};

Rubbing rub(double friction, double duration) {
  Drop d = heap(solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, 0.3), true);
  d.surroundings.contact.friction = friction;
  d.c.options.ode.damping_tangent = d.c.options.ode.damping_normal = 5;
  Rubbing out;
  while (d.c.state.shape.time < duration) {
    go(2e-3, 2e-3, 1000, d);
    for (const Touch& touch : d.c.work.touches) {
      if (touch.solid != two_stage::kItself || !(touch.push > 0)) continue;
      Vec3 way = -touch.from;
      for (const two_stage::Arm& arm : touch.arms()) {
        way += arm.weight * two_stage::material_place(d.c.state.shape, arm.place, arm.eta_start);
      }
      way -= way.dot(touch.normal) * touch.normal;
      const double most = friction * touch.push;
      out.over = std::max(out.over, touch.drag.norm() / most - 1);
      if (way.norm() > 1e-5) out.off = std::max(out.off, (touch.drag / most + way.normalized()).norm());
      out.sliding += way.norm() > 1e-5;
      out.sticking += way.norm() < 1e-7;
    }
  }
  return out;
}

/// Pairs that stick pull at most as Coulomb says, those that slide just so, against their way.
TEST(TwoStagePairs, FrictionOnItselfIsCoulombs) {
  const Rubbing slips = rub(0.3, 1.2), holds = rub(0.8, 1.2);
  std::printf("  %d and %d stick, %d and %d slide\n", slips.sticking, holds.sticking, slips.sliding, holds.sliding);
  show("pull over Coulomb's, less 1", std::max(slips.over, holds.over), 1e-6);
  show("pull of what slides off Coulomb's, over it", slips.off, 0.05);
  EXPECT_LT(slips.over, 1e-6);
  EXPECT_LT(holds.over, 1e-6);
  EXPECT_LT(slips.off, 0.05);
  EXPECT_GT(slips.sliding, 100);
  EXPECT_GT(holds.sticking, 50);
}

/// Meshes, stiffness, speeds and poses at random, of strips that feel themselves.
TEST(TwoStagePairs, RandomDrops) {
  double worst = 0;
  int halvings = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    std::normal_distribution<double> normal;
    const auto turn = [&] { return Quat(normal(random), normal(random), normal(random), normal(random)).normalized(); };
    const contact::Shape shape =
        seed % 2 == 0 ? mesh_ball(0.02 + 0.03 * part(random)) : mesh_box(Vec3(0.03, 0.04, 0.02));
    const double friction = part(random) < 0.3 ? 0 : part(random);
    Drop d = drop(2e-5 * std::pow(10, part(random)), 8 + static_cast<int>(8 * part(random)),
                  {solid(shape, {Vec3::Zero(), turn()}, friction),
                   solid(contact::HalfSpace{}, {Vec3(0, 0, -0.08), Quat::Identity()}, friction)},
                  {0, 0, -kGravity});
    d.surroundings.contact.self = true;
    d.surroundings.contact.friction = friction;
    const Quat frame = math::exp_map(Vec3(0.4 * normal(random), 0.2 * normal(random), 3 * normal(random)));
    place({Vec3(0, 0, 0.12) - frame * Vec3(0.3 * part(random), 0, 0), frame}, d);
    for (Vec3& v : d.c.state.shape.r_dot) v = Vec3(0, 0, -2 * part(random));
    go(0.15, 2e-3, 15, d);
    worst = std::min(worst, d.nearest);
    halvings += d.halvings;
    EXPECT_GT(d.nearest, -0.01 * kWidth);
    EXPECT_EQ(d.crossings, 0);
  }
  std::printf("  steps halved: %d\n", halvings);
  show("largest penetration of random drops over the width", -worst / kWidth, 0.01);
}

/// Both ends of a free strip fly at each other: what it does to itself changes no momentum.
TEST(TwoStagePairs, FoldingKeepsMomentum) {
  Drop d = drop(2e-5, 16, {}, Vec3::Zero());
  d.surroundings.contact.self = true;
  d.surroundings.contact.friction = 0.4;
  const double length = d.c.ribbon.length;
  for (std::size_t i = 0; i < d.c.state.shape.r_dot.size(); ++i) {
    const double u = 2 * d.c.ribbon.node_u[i] / length - 1;  // -1 to 1
    d.c.state.shape.r_dot[i] = Vec3(-0.5 * u, 0.1 * u * u, 3 * u * u);
  }
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < d.c.state.shape.r_dot.size(); ++i)
      sum += d.c.ribbon.node_mass[i] * d.c.state.shape.r_dot[i];
    return sum;
  };
  const Vec3 before = momentum();
  go(0.15, 1e-3, 3, d);
  show("momentum that folding changes, over all", (momentum() - before).norm() / before.norm(), 1e-9);
  EXPECT_LT((momentum() - before).norm(), 1e-9 * before.norm());
  EXPECT_EQ(d.crossings, 0);
  EXPECT_GT(d.most_touching, 1);
}

/// The paper's Fig. 1d: a loop with two half twists, l/w = 5 pi, is thrown off its equilibrium and comes back to the
/// shape of a zero, its inflections edge to edge. V l/(D w) is 56.908 as segments grow; with 50, that of the
/// equilibrium solver, which the soft coupling of this method lowers a little (docs/two-stage.md: 0.02 % of the Moebius
/// band's).
TEST(TwoStagePairs, ALoopWithTwoHalfTwistsHoldsItsZeroShape) {
  Drop d;
  d.surroundings.contact.self = true;
  d.surroundings.contact.distance = 8e-4;
  d.c = loop(50, 2, d.surroundings);
  d.c.ribbon.area_density = 40;
  for (double& mass : d.c.ribbon.node_mass) mass *= 40;
  const auto energy = [&] {
    return energy::elastic_value(d.c.ribbon, d.c.options.model, d.c.state.shape) * d.c.ribbon.length /
           (d.c.ribbon.bending_stiffness * d.c.ribbon.width);
  };
  const double before = energy();
  d.c.options.ode.damping_tangent = d.c.options.ode.damping_normal = 1.5;
  disturb(0.2, d.c);
  d.c.state.shape.r_dot.back() = d.c.state.shape.r_dot.front();
  const two_stage::StepReport report = go(5, 0.01, 20, d);
  show("V l/(D w) over the equilibrium's, less 1", energy() / before - 1, 1e-3);
  show("V l/(D w) over 56.908, less 1", energy() / 56.908 - 1, 5e-3);
  EXPECT_NEAR(energy() / before, 1, 1e-3);
  EXPECT_NEAR(energy() / 56.908, 1, 5e-3);
  EXPECT_EQ(d.crossings, 0);
  EXPECT_GT(report.touching, 0);
  EXPECT_LT(report.push.norm(), 1e-12);  // nothing from outside
}

}  // namespace
}  // namespace wunderlich::testing
