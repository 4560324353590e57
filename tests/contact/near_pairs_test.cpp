/// Overlapping boxes: against all pairs, on sets of every kind of spread.
#include "wunderlich/contact/near_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace wunderlich::contact {
namespace {

Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

enum class Spread { even, clustered, on_a_line, one_place, of_many_sizes };

std::vector<Extent> random_extents(Spread spread, int count, std::mt19937_64& random) {
  std::vector<Extent> extents;
  for (int i = 0; i < count; ++i) {
    Vec3 center = random_vector(random);
    if (spread == Spread::clustered) center = 1e-3 * center + Vec3(i % 3, 0, 5 * (i % 2));
    if (spread == Spread::on_a_line) center = Vec3(0.01 * i, 0, 0);
    if (spread == Spread::one_place) center.setZero();
    const double size = spread == Spread::of_many_sizes ? std::pow(10.0, -(i % 5))
                        : spread == Spread::even        ? 0.2
                                                        : 1e-2;
    const Vec3 half = size * random_vector(random).cwiseAbs();
    extents.push_back({center - half, center + half});
  }
  return extents;
}

std::set<Near> as_set(const std::vector<Near>& pairs) { return {pairs.begin(), pairs.end()}; }

constexpr Spread kSpreads[] = {Spread::even, Spread::clustered, Spread::on_a_line, Spread::one_place,
                               Spread::of_many_sizes};

TEST(NearPairs, AreThoseThatOverlapInOneSet) {
  std::mt19937_64 random(21);
  ExtentTree tree;
  std::vector<Near> pairs;
  for (const Spread spread : kSpreads) {
    for (const int count : {0, 1, 2, 5, 63, 64, 65, 300}) {
      const std::vector<Extent> extents = random_extents(spread, count, random);
      std::set<Near> all;
      for (int i = 0; i < count; ++i) {
        for (int j = i + 1; j < count; ++j) {
          if (extents[static_cast<std::size_t>(i)].overlaps(extents[static_cast<std::size_t>(j)])) all.insert({i, j});
        }
      }
      build_tree(extents, grid_over(extents), tree);
      find_near(tree, pairs);
      EXPECT_EQ(as_set(pairs), all);
      EXPECT_EQ(pairs.size(), all.size()) << "some are there twice";
      EXPECT_TRUE(count < 300 || all.size() > 20);
    }
  }
}

TEST(NearPairs, AreThoseThatOverlapInTwoSets) {
  std::mt19937_64 random(22);
  ExtentTree first, second;
  std::vector<Near> pairs;
  for (const Spread spread : kSpreads) {
    for (const auto& [m, n] : {std::pair{0, 5}, {1, 1}, {3, 250}, {250, 3}, {200, 300}}) {
      const std::vector<Extent> a = random_extents(spread, m, random), b = random_extents(spread, n, random);
      std::set<Near> all;
      for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
          if (a[static_cast<std::size_t>(i)].overlaps(b[static_cast<std::size_t>(j)])) all.insert({i, j});
        }
      }
      build_tree(a, grid_over(b), first);
      build_tree(b, grid_over(b), second);
      find_near(first, second, pairs);
      EXPECT_EQ(as_set(pairs), all);
      EXPECT_EQ(pairs.size(), all.size());
    }
  }
}

TEST(NearPairs, ComeInAnOrderThatEarlierSearchesDoNotChange) {
  std::mt19937_64 random(23);
  const std::vector<Extent> extents = random_extents(Spread::even, 300, random);
  ExtentTree fresh, used;
  const std::vector<Extent> others = random_extents(Spread::clustered, 500, random);
  build_tree(others, grid_over(others), used);
  build_tree(extents, grid_over(extents), used);
  build_tree(extents, grid_over(extents), fresh);
  std::vector<Near> first, second;
  find_near(fresh, first);
  find_near(used, second);
  EXPECT_EQ(first, second);
}

TEST(NearPairs, CountTouchingBoxesAndSurviveWhatIsNoNumber) {
  const Vec3 o = Vec3::Zero(), one = Vec3::Ones();
  ExtentTree tree;
  std::vector<Near> pairs;
  const std::vector<Extent> row{{o, one}, {one, 2 * one}, {3 * one, 4 * one}};
  build_tree(row, grid_over(row), tree);
  find_near(tree, pairs);
  EXPECT_EQ(pairs, (std::vector<Near>{{0, 1}}));
  const double none = std::nan(""), infinite = HUGE_VAL;
  const std::vector<Extent> odd{{o, one}, {one * none, one * none}, {-one * infinite, one * infinite}};
  build_tree(odd, grid_over(row), tree);
  find_near(tree, pairs);
  EXPECT_EQ(pairs, (std::vector<Near>{{0, 2}}));
  build_tree(odd, grid_over(odd), tree);
  find_near(tree, pairs);
}

}  // namespace
}  // namespace wunderlich::contact
