/// How far pairs may go on straight ways: against a dense sampling of the ways.
#include "wunderlich/contact/travel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace wunderlich::contact {
namespace {

constexpr double kLeave = 0.1;

PairPoints between(const PairPoints& x0, const PairPoints& x1, double t) {
  PairPoints x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = x0[k] + t * (x1[k] - x0[k]);
  return x;
}

/// No sample before the share comes too near, and at the share most of the distance is spent.
void expect_free(PairKind kind, const PairPoints& x0, const PairPoints& x1, double offset) {
  const double t = free_share(kind, x0, x1, offset, kLeave), start = pair_distance(kind, x0) - offset;
  ASSERT_GT(t, 0);
  ASSERT_LE(t, 1);
  double nearest = start;
  for (int i = 0; i <= 2000; ++i) {
    nearest = std::min(nearest, pair_distance(kind, between(x0, x1, t * i / 2000)) - offset);
  }
  EXPECT_GE(nearest, (kLeave - 1e-12) * start);
  const double left = pair_distance(kind, between(x0, x1, t)) - offset;
  EXPECT_TRUE(t == 1 || left <= 0.15 * start) << t << " " << left / start;
}

Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

class Travel : public ::testing::TestWithParam<PairKind> {};

TEST_P(Travel, StaysApartOnRandomWays) {
  std::mt19937_64 random(11);
  int cut = 0;
  for (int i = 0; i < 1500; ++i) {
    PairPoints x0, x1;
    for (std::size_t k = 0; k < 4; ++k) {
      x0[k] = random_vector(random);
      x1[k] = x0[k] + std::pow(10.0, i % 5 - 2) * random_vector(random);
    }
    const double offset = 0.5 * (i % 2) * pair_distance(GetParam(), x0);
    expect_free(GetParam(), x0, x1, offset);
    cut += free_share(GetParam(), x0, x1, offset, kLeave) < 1 ? 1 : 0;
  }
  EXPECT_GT(cut, 100);
  EXPECT_LT(cut, 1400);
}

TEST_P(Travel, StaysApartWhereOneTurnsFast) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 200; ++i) {
    PairPoints x0, x1;
    for (Vec3& x : x0) x = random_vector(random);
    const Mat3 turn = Eigen::AngleAxisd(3.0, random_vector(random).normalized()).toRotationMatrix();
    for (std::size_t k = 0; k < 4; ++k) x1[k] = k < 2 ? x0[k] : Vec3(x0[2] + turn * (x0[k] - x0[2]));
    expect_free(GetParam(), x0, x1, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Travel, ::testing::Values(PairKind::vertex_triangle, PairKind::edge_edge));

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();

/// A vertex above a triangle that holds the origin.
PairPoints above(const Vec3& vertex) { return {vertex, 2 * kX, 2 * kY - 2 * kX, -2 * kY - 2 * kX}; }

TEST(TravelOf, AVertexStopsAtTheShareThatItMustLeave) {
  const double t = free_share(PairKind::vertex_triangle, above(kZ), above(-3 * kZ), 0, kLeave);
  EXPECT_LE(t, 0.9 / 4);  // there a tenth is left
  EXPECT_GE(t, 0.95 * 0.9 / 4);
  const double thick = free_share(PairKind::vertex_triangle, above(kZ), above(-3 * kZ), 0.5, kLeave);
  EXPECT_LE(thick, 0.45 / 4);
  EXPECT_GE(thick, 0.95 * 0.45 / 4);
}

TEST(TravelOf, FastOnesDoNotLeapOver) {
  const double t = free_share(PairKind::vertex_triangle, above(1e-3 * kZ), above(-1e6 * kZ), 0, kLeave);
  EXPECT_GT(t, 0.8e-9);
  EXPECT_LT(t, 0.9e-9);
}

TEST(TravelOf, GrazingWaysAreGoneInPartAtLeast) {
  // Parallel to the plane: nothing comes nearer, on a way 100 times and 100,000 times the distance.
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(0.01 * kZ), above(0.01 * kZ + kX), 0, kLeave), 1);
  const PairPoints low = above(1e-5 * kZ), far = above(1e-5 * kZ + kX);
  const double t = free_share(PairKind::vertex_triangle, low, far, 0, kLeave);
  EXPECT_GT(t, 0.005);
  // And one that dips a little: to half of its distance.
  expect_free(PairKind::vertex_triangle, above(0.01 * kZ), above(0.005 * kZ + kX), 0);
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(0.01 * kZ), above(0.005 * kZ + kX), 0, kLeave), 1);
  // Past the end of an edge
  const PairPoints x0{-kX, kX, 1.001 * kX - kY + kZ, 1.001 * kX - kY - kZ};
  PairPoints x1 = x0;
  for (std::size_t k = 2; k < 4; ++k) x1[k] += 2 * kY;
  EXPECT_LT(pair_distance(PairKind::edge_edge, between(x0, x1, 0.5)), 0.0011);
  expect_free(PairKind::edge_edge, x0, x1, 0);
}

TEST(TravelOf, CommonWaysAreFreeAndRestIs) {
  PairPoints moved = above(1e-6 * kZ);
  for (Vec3& x : moved) x += Vec3(3, -5, 7);
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(1e-6 * kZ), moved, 0, kLeave), 1);
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(kZ), above(kZ), 0, kLeave), 1);
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(kZ), above(9 * kZ), 0, kLeave), 1);
}

TEST(TravelOf, WhatTouchesMayNotGo) {
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(0 * kZ), above(kZ), 0, kLeave), 0);
  EXPECT_EQ(free_share(PairKind::vertex_triangle, above(kZ), above(2 * kZ), 1.5, kLeave), 0);
}

}  // namespace
}  // namespace wunderlich::contact
