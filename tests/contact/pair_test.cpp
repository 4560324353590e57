/// Pairs of surface parts: distances against a search over both, derivatives of the barrier against differences in
/// every way in which two of them can be nearest, and pairs that have lost their shape.
#include "wunderlich/contact/pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "support/taylor.hpp"

namespace wunderlich::contact {
namespace {

constexpr PairKind kKinds[] = {PairKind::vertex_triangle, PairKind::edge_edge};

Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

PairPoints random_points(std::mt19937_64& random) {
  return {random_vector(random), random_vector(random), random_vector(random), random_vector(random)};
}

PairPoints moved(const PairPoints& x, const Vec12& by) {
  PairPoints out;
  for (std::size_t k = 0; k < 4; ++k) out[k] = x[k] + by.segment<3>(3 * static_cast<int>(k));
  return out;
}

Vec12 random_move(std::mt19937_64& random, double size) {
  Vec12 move;
  for (int k = 0; k < 4; ++k) move.segment<3>(3 * k) = random_vector(random);
  return size * move.normalized();
}

/// Which of the four points carry the nearest ones, a bit each.
unsigned region(PairKind kind, const PairPoints& x) {
  const PairNearest nearest = pair_nearest(kind, x);
  unsigned bits = 0;
  for (unsigned k = 0; k < 4; ++k) bits |= nearest.weights[k] != 0 ? 1u << k : 0;
  return bits;
}

/// Points of one region, moved so that they are `distance` apart.
bool move_to(PairKind kind, double distance, PairPoints& x) {
  const PairNearest nearest = pair_nearest(kind, x);
  const Vec3 shift = (distance / nearest.distance - 1) * nearest.way;
  for (std::size_t k = 0; k < (kind == PairKind::vertex_triangle ? 1 : 2); ++k) x[k] += shift;
  return std::abs(pair_distance(kind, x) - distance) < 1e-9;
}

Eigen::VectorXd scalar(double value) { return Eigen::VectorXd::Constant(1, value); }

/// Both derivatives along a random move that stays in the region; false if it does not.
bool expect_derivatives(PairKind kind, const PairPoints& x, const Gap& gap, std::mt19937_64& random) {
  const Vec12 move = random_move(random, 0.05);
  for (const double h : {-0.01, 0.01}) {
    if (region(kind, moved(x, h * move)) != region(kind, x)) return false;
  }
  const auto at = [&](double h) { return pair_energy(kind, moved(x, h * move), gap); };
  const PairEnergy here = at(0);
  EXPECT_EQ(here.value, pair_value(kind, x, gap));
  EXPECT_GT(here.gradient.norm(), 0);
  EXPECT_GT(here.hessian.norm(), 0);
  EXPECT_LT((here.hessian - here.hessian.transpose()).norm(), 1e-12 * here.hessian.norm());
  testing::expect_derivative([&](double h) { return scalar(at(h).value); }, scalar(here.gradient.dot(move)));
  testing::expect_derivative([&](double h) { return Eigen::VectorXd(at(h).gradient); }, here.hessian * move);
  return true;
}

TEST(Pair, HasTheDerivativesOfItsBarrierInEveryRegion) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.3, 0.8);
  for (const PairKind kind : kKinds) {
    std::map<unsigned, int> seen;
    for (int attempt = 0; attempt < 4000; ++attempt) {
      PairPoints x = random_points(random);
      const Gap gap{0.3, attempt % 2 == 0 ? 0 : 0.1, 0};
      const double distance = gap.offset + uniform(random) * gap.reach;
      const unsigned before = region(kind, x);
      if (seen[before] >= 4 || !move_to(kind, distance, x) || region(kind, x) != before) continue;
      SCOPED_TRACE(::testing::Message() << "region " << before << " of kind " << static_cast<int>(kind));
      seen[before] += expect_derivatives(kind, x, gap, random) ? 1 : 0;
    }
    EXPECT_EQ(seen.size(), kind == PairKind::vertex_triangle ? 7u : 9u);
    for (const auto& [bits, count] : seen) EXPECT_EQ(count, 4) << bits;
  }
}

/// Two edges side by side, `angle` apart, the second shifted along the first.
PairPoints nearly_parallel(double angle, double shift, std::mt19937_64& random) {
  const Vec3 along = random_vector(random).normalized(), across = along.cross(random_vector(random)).normalized();
  const Vec3 turned = std::cos(angle) * along + std::sin(angle) * along.cross(across);
  return {-along, along, 0.15 * across + shift * along - turned, 0.15 * across + shift * along + turned};
}

TEST(Pair, HasTheDerivativesOfItsBarrierWhereEdgesAreNearlyParallel) {
  std::mt19937_64 random(6);
  std::map<unsigned, int> seen;
  for (int attempt = 0; attempt < 200; ++attempt) {
    PairPoints x = nearly_parallel(0.15 + 0.1 * (attempt % 3), 0.35 * (attempt % 7), random);
    const Gap gap{0.3, 0.02, 4.0};
    if (!move_to(PairKind::edge_edge, 0.16, x)) continue;
    ASSERT_LT((x[1] - x[0]).cross(x[3] - x[2]).squaredNorm(), gap.parallel);
    seen[region(PairKind::edge_edge, x)] += expect_derivatives(PairKind::edge_edge, x, gap, random) ? 1 : 0;
  }
  EXPECT_GE(seen[15], 20);  // inside both
  EXPECT_GE(seen.size(), 3u);
}

TEST(Pair, IsContinuouslyDifferentiableWhereEdgesTurnThroughParallel) {
  std::mt19937_64 random(7);
  const Gap gap{0.3, 0, 1e-2};
  for (int i = 0; i < 20; ++i) {
    const auto state = random;
    const auto gradient = [&](double angle) {
      random = state;
      return pair_energy(PairKind::edge_edge, nearly_parallel(angle, 0.1 * i, random), gap).gradient;
    };
    // The nearest points leap from end to end between the two, so what is continuous has fallen to nothing.
    EXPECT_LT((gradient(1e-6) - gradient(-1e-6)).norm(), 1e-3);
    EXPECT_GT(gradient(0.04).norm(), 0.05);
    random.discard(100);
  }
}

/// Distance by a search that knows no regions: the distance from a point of a line to a segment is convex along the
/// line.
double searched(PairKind kind, const PairPoints& x) {
  const auto beyond = [&](double s) {
    Vec3 from = x[0] + s * (x[1] - x[0]), a = x[2], b = x[3];
    if (kind == PairKind::vertex_triangle) {  // the triangle is a fan of segments along its side from 1 to 3
      from = x[0];
      a = x[1] + s * (x[2] - x[1]);
      b = x[3] + s * (x[2] - x[3]);
    }
    const double t = std::clamp((from - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (from - a - t * (b - a)).norm();
  };
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double third = (high - low) / 3;
    (beyond(low + third) < beyond(high - third) ? high : low) +=
        beyond(low + third) < beyond(high - third) ? -third : third;
  }
  return std::min({beyond(low), beyond(0), beyond(1 - 1e-12)});
}

TEST(Pair, HasTheDistanceThatASearchFinds) {
  std::mt19937_64 random(8);
  for (const PairKind kind : kKinds) {
    for (int i = 0; i < 300; ++i) {
      const PairPoints x = random_points(random);
      const PairNearest nearest = pair_nearest(kind, x);
      EXPECT_NEAR(nearest.distance, searched(kind, x), 1e-10);
      const Vec4& w = nearest.weights;
      EXPECT_LT((w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + w[3] * x[3] - nearest.way).norm(), 1e-14);
      const double first = kind == PairKind::edge_edge ? w[0] + w[1] : w[0];
      EXPECT_NEAR(first, 1, 1e-15);
      EXPECT_NEAR(w.sum(), 0, 1e-15);
    }
  }
}

TEST(Pair, HasTheDistanceOfWhatIsLeftOfDegenerateParts) {
  const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto vt = PairKind::vertex_triangle, ee = PairKind::edge_edge;
  EXPECT_DOUBLE_EQ(pair_distance(vt, {z, o, o, o}), 1);
  EXPECT_DOUBLE_EQ(pair_distance(vt, {z, -x, x, 2 * x}), 1);      // a triangle that is a line
  EXPECT_DOUBLE_EQ(pair_distance(vt, {3 * x, -x, x, 2 * x}), 1);  // beyond its end
  EXPECT_NEAR(pair_distance(vt, {0.2 * x, -x, x + y, x - y}), 0, 1e-15);
  EXPECT_DOUBLE_EQ(pair_distance(ee, {o, o, z, z}), 1);
  EXPECT_DOUBLE_EQ(pair_distance(ee, {o, o, z - x, z + x}), 1);
  EXPECT_DOUBLE_EQ(pair_distance(ee, {-x, x, z - x, z + x}), 1);  // parallel
  EXPECT_DOUBLE_EQ(pair_distance(ee, {-x, x, 3 * x, 4 * x}), 2);  // on one line
  EXPECT_DOUBLE_EQ(pair_distance(ee, {-x, x, -y, y}), 0);         // crossing
  EXPECT_DOUBLE_EQ(pair_distance(ee, {-x, x, z - 1e-9 * y - x, z + 1e-9 * y + x}), 1);
  const Gap gap{2, 0, 1e-3};
  for (const PairKind kind : kKinds) {
    for (const PairPoints& points :
         {PairPoints{2 * z, z, x, x}, PairPoints{o, x, z, z + x}, PairPoints{z, 2 * z, x, 2 * x}}) {
      const PairEnergy energy = pair_energy(kind, points, gap);
      EXPECT_TRUE(std::isfinite(energy.value) && energy.gradient.allFinite() && energy.hessian.allFinite());
    }
  }
}

TEST(Pair, BeginsAtItsReachAndIsInfiniteAtItsOffset) {
  const Gap gap{0.2, 0.1, 0};
  const auto at = [&](double d) {
    const Vec3 o = Vec3::Zero();
    return pair_energy(PairKind::vertex_triangle, {Vec3(0.2, 0.2, d), o, Vec3::UnitX(), Vec3::UnitY()}, gap);
  };
  EXPECT_EQ(at(0.31).value, 0);
  EXPECT_EQ(at(0.31).hessian.norm(), 0);
  EXPECT_NEAR(at(0.2).value, 0.01 * std::log(2.0), 1e-15);  // at half of the reach
  EXPECT_NEAR(at(0.2).gradient[2], -0.2 * std::log(2.0) - 0.1, 1e-14);
  EXPECT_EQ(at(0.1).value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(at(0.05).value, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace wunderlich::contact
