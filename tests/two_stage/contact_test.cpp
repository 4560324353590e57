// Contact in the two-stage method: its rows against finite differences, its small problems against their definition,
// and strips that fall, rest, slide and are pushed, looked at by points of the facets apart from the solver's.
// @eq Shen2015:6.3
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "two_stage/drops.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using two_stage::Projection;
using two_stage::Row;
using two_stage::Vec7;

TEST(TwoStageContact, EquationsAreDerivatives) {
  std::mt19937 random(11);
  for (const NamedRibbon& sample : sample_ribbons()) {
    SCOPED_TRACE(sample.name);
    Loose l = loose(sample.ribbon, random);
    ASSERT_TRUE(two_stage::assemble_equations(l.ribbon, l.options, l.shape, l.work));
    const std::vector<Row> rows = l.work.equations.rows;
    const double h = 1e-6;
    const geometry::State plus = moved(h, l), minus = moved(-h, l);
    two_stage::assemble_equations(l.ribbon, l.options, plus, l.work);
    const std::vector<Row> high = l.work.equations.rows;
    two_stage::assemble_equations(l.ribbon, l.options, minus, l.work);
    double largest = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double slope = along(rows[i], l.motion), change = high[i].residual - l.work.equations.rows[i].residual;
      largest = std::max(largest, std::abs(slope));
      EXPECT_NEAR(slope, change / (2 * h), 1e-6 * (1 + std::abs(slope))) << "row " << i;
    }
    EXPECT_GT(largest, 0.1);
  }
}

TEST(TwoStageContact, RowsOfPointsAndBoundsAreDerivatives) {
  std::mt19937 random(12);
  for (const NamedRibbon& sample : sample_ribbons()) {
    SCOPED_TRACE(sample.name);
    Loose l = loose(sample.ribbon, random);
    ASSERT_TRUE(two_stage::assemble_equations(l.ribbon, l.options, l.shape, l.work));
    const double h = 1e-6;
    const geometry::State plus = moved(h, l), minus = moved(-h, l);
    const Vec3 direction = Vec3(0.3, -0.5, 0.8).normalized();
    const double size = l.ribbon.rest_length.front();
    for (std::size_t s = 0; s < l.shape.q.size(); ++s) {
      const two_stage::Place place{s, 0.3, 0.4 * l.ribbon.width};
      const double eta = two_stage::eta_at(l.shape, place);
      Row row;
      row = Row();
      two_stage::add_point(l.ribbon, l.shape, place, eta, direction, true, l.work, row);
      const Vec3 way = two_stage::place_of(plus, place) - two_stage::place_of(minus, place);
      EXPECT_NEAR(along(row, l.motion), direction.dot(way) / (2 * h), 1e-5 * size);
      EXPECT_GT(row.slope.cwiseAbs().maxCoeff(), 0.1);
      row = Row();
      two_stage::add_point(l.ribbon, l.shape, place, eta, direction, false, l.work, row);
      const Vec3 carried = two_stage::material_place(plus, place, eta) - two_stage::material_place(minus, place, eta);
      EXPECT_NEAR(along(row, l.motion), direction.dot(carried) / (2 * h), 1e-5 * size);
      Row after, before;
      two_stage::bound_row(l.ribbon, l.shape, s, 1, l.work, row);
      two_stage::bound_row(l.ribbon, plus, s, 1, l.work, after);
      two_stage::bound_row(l.ribbon, minus, s, 1, l.work, before);
      EXPECT_NEAR(along(row, l.motion), (after.residual - before.residual) / (2 * h), 1e-5);
    }
  }
}

/// Signorini's and Coulomb's conditions on random problems, with rows that repeat others.
TEST(TwoStageContact, ConesFulfilTheirConditions) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  int pushing = 0, sliding = 0, open = 0;
  for (int problem = 0; problem < 40; ++problem) {
    constexpr int kContacts = 6, kSize = 3 * kContacts;
    Eigen::MatrixXd j = Eigen::MatrixXd::NullaryExpr(kSize, 14, [&] { return normal(random); });
    j.middleRows(3, 3) = j.middleRows(0, 3);
    Eigen::VectorXd b = j * Eigen::VectorXd::NullaryExpr(14, [&] { return normal(random); });
    two_stage::ConeProblem cones;
    cones.size = kSize;
    const Eigen::MatrixXd a = j * j.transpose();
    cones.matrix.assign(a.data(), a.data() + a.size());
    cones.slack.assign(b.data(), b.data() + b.size());
    cones.force.assign(kSize, 0.0);
    for (int k = 0; k < kContacts; ++k) {
      for (const double mu : {0.4, -1.0, -1.0}) cones.friction.push_back(mu);
    }
    const two_stage::ConeReport report = two_stage::solve_cones(1e-9, 0, 5000, cones);
    ASSERT_FALSE(report.capped) << problem;
    const Eigen::Map<const Eigen::VectorXd> x(cones.force.data(), kSize);
    const Eigen::VectorXd w = b + a * x;
    for (int k = 0; k < kSize; k += 3) {
      const double limit = 0.4 * x[k];
      const Vec2 drag = x.segment<2>(k + 1), way = w.segment<2>(k + 1);
      EXPECT_GE(x[k], 0);
      EXPECT_GT(w[k], -1e-7);
      EXPECT_LT(std::abs(x[k] * w[k]), 1e-6);
      EXPECT_LE(drag.norm(), limit + 1e-12);
      if (drag.norm() < limit - 1e-6) {
        EXPECT_LT(way.norm(), 1e-6);
      } else {
        EXPECT_LT((drag * way.norm() + limit * way).norm(), 1e-5) << "friction is not against the way";
      }
      pushing += x[k] > 1e-6;
      open += w[k] > 1e-6;
      sliding += x[k] > 1e-6 && way.norm() > 1e-6;
    }
  }
  EXPECT_GT(pushing, 20);
  EXPECT_GT(sliding, 10);
  EXPECT_GT(open, 20);
}

Pose axis_y(double x, double z, double turn) {
  return {Vec3(x, 0, z), math::exp_map(Vec3(0, 0, turn)) * math::exp_map(Vec3(-std::acos(0.0), 0, 0))};
}

TEST(TwoStageContact, ADrapeStaysOut) {
  for (const double turn : {0.0, 0.5}) {
    Drop d = drop(2e-5, 20, {solid(contact::Cylinder{0.03, 1e9}, axis_y(0.15, -0.05, turn), 0.3)}, {0, 0, -kGravity});
    const two_stage::StepReport report = go(0.35, 1.4e-3, 3, d);
    show("penetration of a drape over the width", -d.nearest / kWidth, 0.01);
    EXPECT_GT(d.nearest, -0.01 * kWidth);
    EXPECT_LT(d.nearest, kWidth / 30);  // it got there
    EXPECT_LT(report.constraints.max_length_error, 1e-6);
    EXPECT_LT(report.constraints.max_torsion_mismatch, 1e-6);
    EXPECT_LT(report.constraints.max_binormal, 1e-6);
  }
}

/// The paper's sweeps reach the same.
TEST(TwoStageContact, SweepsKeepADrapeOutToo) {
  Drop d = drop(2e-5, 10, {solid(contact::Cylinder{0.03, 1e9}, axis_y(0.15, -0.03117, 0.3), 0.3)}, {0, 0, -kGravity});
  d.c.options.opt.projection = Projection::gauss_seidel;
  d.c.options.opt.minimiser = two_stage::Minimiser::lbfgs;
  go(0.08, 5e-3, 1, d);
  show("penetration of a drape with sweeps over the width", -d.nearest / kWidth, 0.01);
  EXPECT_GT(d.nearest, -0.01 * kWidth);
  EXPECT_LT(d.nearest, kWidth / 30);
  EXPECT_GT(d.sweeps, 100);
}

TEST(TwoStageContact, ReactionIsTheWeight) {
  for (const Projection projection : {Projection::direct, Projection::gauss_seidel}) {
    Drop d = drop(1e-3, 12, {solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, 0.3)}, {0, 0, -kGravity});
    d.c.options.opt.projection = projection;
    place({Vec3(0, 0, 1e-5), Quat::Identity()}, d);
    const two_stage::StepReport report = go(0.06, 4e-4, 10, d);
    const double weight = 0.3 * kWidth * 0.1 * kGravity;
    show("reaction over weight, less 1", std::abs(report.push.z() / weight - 1), 1e-6);
    EXPECT_NEAR(report.push.z() / weight, 1, 1e-6);
    EXPECT_LT(report.push.head<2>().norm() / weight, 1e-6);
  }
}

TEST(TwoStageContact, ThicknessIsKept) {
  Drop d = drop(1e-3, 12, {solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()})}, {0, 0, -kGravity});
  d.surroundings.contact.thickness = 2e-3;
  place({Vec3(0, 0, 2.2e-3), Quat::Identity()}, d);
  go(0.05, 4e-4, 5, d);
  EXPECT_NEAR(d.c.state.shape.r[6].z(), 2e-3, 1e-5);
  EXPECT_GT(d.nearest, -0.01 * kWidth);
}

/// Speed along the slope, down it, after 0.1 s from rest.
double slide(double slope, double friction) {
  const double alpha = std::atan(slope);
  // The plane is level and gravity leans: down the slope is (1, 1, 0)/sqrt(2), aslant to the strip.
  const Vec3 down = Vec3(1, 1, 0).normalized();
  Drop d = drop(1e-3, 10, {solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, friction)},
                kGravity * (std::sin(alpha) * down - std::cos(alpha) * Vec3::UnitZ()));
  go(0.1, 5e-4, 50, d);
  return d.c.state.shape.r_dot[5].dot(down);
}

TEST(TwoStageContact, AStripSlipsOnASlopeAsCoulombSays) {
  for (const double friction : {0.1, 0.3, 0.6}) {
    for (const double ratio : {0.99, 1.01, 1.5}) {
      const double alpha = std::atan(ratio * friction), speed = slide(ratio * friction, friction);
      const double free = 0.1 * kGravity * (std::sin(alpha) - friction * std::cos(alpha));
      std::printf("  mu %.1f, tan(alpha)/mu %.2f: %.4g m/s, Coulomb %.4g\n", friction, ratio, speed,
                  std::max(0.0, free));
      EXPECT_NEAR(speed, std::max(0.0, free), 0.02 * std::abs(free) + 1e-7);
    }
  }
}

/// A plane that moves takes a strip along, and no faster than itself.
TEST(TwoStageContact, AMovingFloorTakesTheStripAlong) {
  constraint::Obstacle belt = solid(contact::HalfSpace{}, {Vec3::Zero(), Quat::Identity()}, 0.5);
  belt.motion.keys.push_back({1, {Vec3(0.1, 0.05, 0), Quat::Identity()}, 0});
  Drop d = drop(1e-3, 10, {belt}, {0, 0, -kGravity});
  go(0.1, 5e-4, 20, d);
  for (const Vec3& v : d.c.state.shape.r_dot) EXPECT_LT((v - Vec3(0.1, 0.05, 0)).norm(), 1e-4);
}

TEST(TwoStageContact, AMovingSolidPushes) {
  constraint::Obstacle ball = solid(contact::Sphere{0.05}, {Vec3(0.15, 0, -0.06), Quat::Identity()});
  ball.motion.keys.push_back({0.1, {Vec3(0.15, 0, 0.06), Quat::Identity()}, 0});
  Drop d = drop(1e-4, 20, {ball}, Vec3::Zero());
  go(0.12, 1e-3, 2, d);
  EXPECT_GT(d.nearest, -0.01 * kWidth);
  EXPECT_GT(d.c.state.shape.r[10].z(), 0.1);
}

/// Against a thin rod, at a speed that goes several diameters in a substep.
TEST(TwoStageContact, NothingIsLeaptOver) {
  Drop d = drop(2e-5, 20, {solid(contact::Capsule{1e-3, 1}, axis_y(0.15, -0.1, 0))}, Vec3::Zero());
  for (Vec3& v : d.c.state.shape.r_dot) v = Vec3(0, 0, -8);
  go(0.03, 1e-3, 1, d);
  EXPECT_GT(d.nearest, -0.01 * kWidth);
  EXPECT_GT(d.c.state.shape.r[10].z(), -0.12);  // it hangs over the rod ...
  EXPECT_LT(d.c.state.shape.r[0].z(), -0.2);
}

/// Solids, stiffness, speeds and poses at random: nothing breaks, nothing is cut.
TEST(TwoStageContact, RandomDrops) {
  double worst = 0;
  int halvings = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    std::normal_distribution<double> normal;
    const auto turn = [&] { return Quat(normal(random), normal(random), normal(random), normal(random)).normalized(); };
    const double friction = part(random) < 0.3 ? 0 : part(random);
    const std::vector<contact::Shape> shapes{contact::Sphere{0.02 + 0.03 * part(random)},
                                             contact::Cylinder{0.02 + 0.02 * part(random), 0.05},
                                             contact::Capsule{0.02, 0.05}, contact::Box{Vec3(0.03, 0.04, 0.02)}};
    const contact::Shape shape = shapes[seed % shapes.size()];
    std::vector<constraint::Obstacle> solids{
        solid(shape, {Vec3::Zero(), turn()}, friction),
        solid(contact::HalfSpace{}, {Vec3(0, 0, -0.1), Quat::Identity()}, friction)};
    Drop d = drop(2e-5 * std::pow(10, part(random)), 8 + static_cast<int>(8 * part(random)), solids, {0, 0, -kGravity});
    const Quat frame = math::exp_map(Vec3(0.4 * normal(random), 0.2 * normal(random), 3 * normal(random)));
    place({Vec3(0, 0, 0.12) - frame * Vec3(0.3 * part(random), 0, 0), frame}, d);
    for (Vec3& v : d.c.state.shape.r_dot) v = Vec3(0, 0, -2 * part(random));
    go(0.12, 2e-3, 2, d);
    worst = std::min(worst, d.nearest);
    halvings += d.halvings;
    EXPECT_GT(d.nearest, -0.01 * kWidth);
    EXPECT_LT(d.nearest, 0.05);
  }
  std::printf("  steps halved: %d\n", halvings);
  show("largest penetration of random drops over the width", -worst / kWidth, 0.01);
}

}  // namespace
}  // namespace wunderlich::testing
