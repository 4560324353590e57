#include "wunderlich/picture/camera.hpp"

#include "picture/sample.hpp"

namespace wunderlich::picture {
namespace {

using testing::strip;

TEST(View, IsARightHandedFrameThatFollowsTheAngles) {
  for (const double azimuth : {0.0, 0.7, 3.0, -2.0}) {
    for (const double elevation : {-1.5, 0.0, 0.4, 1.5}) {
      const View view = view_from({azimuth, elevation});
      EXPECT_LT((view.right.cross(view.up) - view.towards).norm(), 1e-14);
      EXPECT_NEAR(view.towards.z(), std::sin(elevation), 1e-14);
      EXPECT_NEAR(view.right.z(), 0, 1e-14);
    }
  }
  EXPECT_LT((view_from({0, 0}).towards + Vec3::UnitY()).norm(), 1e-14);
}

TEST(View, ShowsTheBroadSide) {
  // An arc that stands in the plane y = 0 is looked at along y, from the usual side.
  const View view = best_view(strip(3, 0.1, 60, 2, 1.0).surface);
  EXPECT_LT(view.towards.y(), -0.7);
}

TEST(Camera, HasEveryPointInThePictureAndFillsIt) {
  const Frame frame = strip(3, 0.4, 40, 2, 1.3);
  const std::vector<std::vector<Vec3>> points{frame.surface.points};
  const std::vector<Fit> fits = fits_of(points);
  for (const double aspect : {0.5, 1.6, 3.0}) {
    const Camera camera = frame_all(best_view(frame.surface), aspect, points, fits);
    double most = 0;
    for (const Vec3& p : points[0]) {
      const Vec3 d = fits[0].on_stage(p) - camera.eye;
      const double depth = -d.dot(camera.view.towards);
      ASSERT_GT(depth, 0);
      most = std::max({most, std::abs(d.dot(camera.view.right)) / (depth * aspect * camera.half_height),
                       std::abs(d.dot(camera.view.up)) / (depth * camera.half_height)});
    }
    EXPECT_NEAR(most, 0.82, 1e-9);
  }
}

TEST(Fits, StandStillUnlessTheRibbonWouldBeSmall) {
  std::vector<Vec3> last{Vec3(0, 0, 0), Vec3(2, 0, 1)}, near = last, far = last;
  for (Vec3& p : near) p.x() += 0.5;
  for (Vec3& p : far) p.x() += 50;
  const std::vector<Fit> still = fits_of({near, last}), followed = fits_of({far, last});
  EXPECT_EQ(still[0].centre, still[1].centre);
  EXPECT_EQ(followed[0].centre, Vec3(51, 0, 0.5));
  EXPECT_EQ(followed[1].centre, Vec3(1, 0, 0.5));
  EXPECT_EQ(followed[1].floor, 0);
}

TEST(ShownPoints, HoldBodiesThatAreNotMuchLarger) {
  const Frame frame = strip(1, 0.1, 10, 1);
  Body ball{strip(0.5, 0.5, 1, 1).surface, {{Vec3(3, 0, 0), Quat::Identity()}}};
  Body ground{strip(9, 9, 1, 1).surface, {Pose{}}};
  const auto points = shown_points({&frame}, {ball, ground}, {0});
  ASSERT_EQ(points[0].size(), frame.surface.points.size() + 4);
  EXPECT_EQ(points[0].back().x(), 3.5);
}

}  // namespace
}  // namespace wunderlich::picture
