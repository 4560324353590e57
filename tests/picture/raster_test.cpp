#include "wunderlich/picture/raster.hpp"

#include <gtest/gtest.h>

#include <random>

#include "wunderlich/picture/shadow.hpp"

namespace wunderlich::picture {
namespace {

double area(const std::array<Vec3, 3>& at) {
  const Vec3 p = at[1] - at[0], q = at[2] - at[0];
  return 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
}

TEST(Cover, CountsTheAreaWithinHalfASampleOfTheEdges) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(5, 195);
  for (int trial = 0; trial < 100; ++trial) {
    std::array<Vec3, 3> at;
    for (Vec3& p : at) p = Vec3(place(random), place(random), 1);
    int count = 0;
    cover(at, {0, 0, 200, 200}, [&](int, int, const Weights& w) {
      EXPECT_NEAR(w.a + w.b + w.c, 1, 1e-5);
      ++count;
    });
    const double edges = (at[0] - at[1]).norm() + (at[1] - at[2]).norm() + (at[2] - at[0]).norm();
    EXPECT_NEAR(count, area(at), 0.5 * edges + 1);
  }
}

TEST(Cover, LeavesNoGapBetweenTrianglesAndStaysInItsWindow) {
  // A square fan about a point that lies anywhere.
  std::vector<int> hits(64 * 64, 0);
  const std::array<Vec3, 4> corners{Vec3(-3, -3, 1), Vec3(70, -3, 1), Vec3(70, 70, 1), Vec3(-3, 70, 1)};
  const Vec3 centre(23.31, 40.77, 1);
  const Window window{8, 16, 64, 48};
  for (std::size_t k = 0; k < 4; ++k) {
    cover({centre, corners[k], corners[(k + 1) % 4]}, window, [&](int x, int y, const Weights&) {
      ASSERT_TRUE(x >= 8 && x < 64 && y >= 16 && y < 48);
      ++hits[static_cast<std::size_t>(64 * y + x)];
    });
  }
  for (int y = 16; y < 48; ++y) {
    for (int x = 8; x < 64; ++x) EXPECT_GE(hits[static_cast<std::size_t>(64 * y + x)], 1) << x << " " << y;
  }
}

Projection usual_projection() { return {{view_from({0, 0}), Vec3(0, -2, 0), 0.5, 1.0}, 400, 400}; }

TEST(Projection, IsThatOfAPinhole) {
  // From -y at distance 2 a height of 1 fills the picture: half_height 0.5 at distance 1.
  const Projection projection = usual_projection();
  const Vec3 middle = projection.sample(projection.eye_space(Vec3::Zero()));
  EXPECT_TRUE(middle.isApprox(Vec3(200, 200, 0.5)));
  const Vec3 corner = projection.sample(projection.eye_space(Vec3(0.5, 0, 1)));
  EXPECT_NEAR(corner.x(), 300, 1e-3);
  EXPECT_NEAR(corner.y(), 0, 1e-3);
}

TEST(Projection, CutsWhatReachesBehindTheEye) {
  // A floor from far in front to far behind: what is drawn has no point behind, and meets the picture's lower edge.
  const Projection projection = usual_projection();
  std::vector<Patch> patches;
  const auto corner = [](double x, double y) {
    return Corner{Vec3(x, y, -0.5).cast<float>(), Point::UnitZ(), Point::Ones()};
  };
  project(projection, {corner(-50, -60), corner(50, -60), corner(0, 40)}, patches);
  ASSERT_FALSE(patches.empty());
  bool lower_edge = false;
  for (const Patch& patch : patches) {
    for (const Vec3& p : patch.at) EXPECT_TRUE(p.z() > 0 && p.z() <= 1.001 / near_plane);
    cover(patch.at, {0, 399, 400, 400}, [&](int, int, const Weights&) { lower_edge = true; });
  }
  EXPECT_TRUE(lower_edge);
  patches.clear();
  project(projection, {corner(-1, -3), corner(1, -3), corner(0, -4)}, patches);
  EXPECT_TRUE(patches.empty());
}

TEST(Projection, KnowsTheFrontFromTheBack) {
  const Projection projection = usual_projection();
  std::vector<Patch> patches;
  const Corner a{Point(0, 0, 0)}, b{Point(1, 0, 0)}, c{Point(0, 0, 1)};  // counter-clockwise seen from -y
  project(projection, {a, b, c}, patches);
  project(projection, {a, c, b}, patches);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_TRUE(patches[0].front);
  EXPECT_FALSE(patches[1].front);
}

TEST(Shadow, FallsAwayFromTheLight) {
  const Vec3 a(-0.2, -0.2, 0.5), b(0.2, -0.2, 0.5), c(0.2, 0.2, 0.5), d(-0.2, 0.2, 0.5);
  const Shadow shadow({{a, b, c}, {a, c, d}});
  const Vec3 below = Vec3(0, 0, 0.5) - light * (0.5 / light.z());
  EXPECT_EQ(shadow.at(below, 2, 2), 1);
  EXPECT_EQ(shadow.at(Vec3(0, 0, 0.5) + 0.1 * light, 2, 2), 0);
  EXPECT_EQ(shadow.at(below + Vec3(0.5, 0, 0), 2, 2), 0);
  EXPECT_EQ(shadow.at(Vec3(100, 0, 0), 2, 2), 0);
  const float edge = shadow.at(below + Vec3(0.2, 0, 0), 4, 4);
  EXPECT_TRUE(edge > 0.2f && edge < 0.8f) << edge;
}

}  // namespace
}  // namespace wunderlich::picture
