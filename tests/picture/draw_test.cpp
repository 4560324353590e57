#include "wunderlich/picture/draw.hpp"

#include "picture/sample.hpp"
#include "wunderlich/picture/lines.hpp"

namespace wunderlich::picture {
namespace {

using testing::pattern;
using testing::strip;

struct Rgb {
  int r, g, b;
  bool paint() const { return r - b > 60; }  // of a ribbon; the background and its shadows are nearly grey
};

Rgb at(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
  return {p[0], p[1], p[2]};
}

const Direction from_above{0, M_PI / 2};

TEST(Draw, AFlatStripIsARectangleOfItsShape) {
  // From above everything is at one distance: 0.82 of the picture's width, and as high as w / l of that.
  const std::vector<Frame> frames{strip(1, 0.2, 10, 2)};
  const std::vector<Body> bodies;
  const std::vector<FlatPattern> strips{pattern(1, 0.2)};
  Style style;
  style.width = 400, style.height = 250;
  style.view = from_above;
  const Image image = still({frames, bodies, strips}, style);
  int left = 400, right = 0, top = 250, bottom = 0;
  for (int y = 0; y < 250; ++y) {
    for (int x = 0; x < 400; ++x) {
      if (!at(image, x, y).paint()) continue;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(right - left + 1, 0.82 * 400, 2);
  EXPECT_NEAR(bottom - top + 1, 0.82 * 400 * 0.2, 2);
}

TEST(Draw, TheBackOfATwoSidedStripHasItsOwnColour) {
  const std::vector<Frame> frames{strip(1, 0.4, 10, 2)};
  const std::vector<Body> bodies;
  std::vector<FlatPattern> strips{pattern(1, 0.4)};
  Style style;
  style.width = 200, style.height = 120;
  style.view = from_above;
  const auto middle = [&] { return at(still({frames, bodies, strips}, style), 92, 56); };
  const Rgb front = middle();
  style.view->elevation = -M_PI / 2;
  const Rgb back = middle();
  strips[0].loop = true;
  strips[0].half_twists = 1;
  const Rgb one_sided = middle();
  EXPECT_GT(front.r - front.g, 80);
  EXPECT_LT(back.r - back.g, 60);
  EXPECT_GT(one_sided.r - one_sided.g, 80);
}

TEST(Draw, TheNearerHidesTheFarther) {
  // A body over the strip hides it from above, and not from below.
  const std::vector<Frame> frames{strip(1, 0.4, 10, 2)};
  std::vector<Body> bodies{{strip(1, 0.4, 1, 1).surface, {{Vec3(0, 0, 0.1), Quat::Identity()}}}};
  const std::vector<FlatPattern> strips{pattern(1, 0.4)};
  Style style;
  style.width = 200, style.height = 120;
  style.view = from_above;
  const Image above = still({frames, bodies, strips}, style);
  EXPECT_FALSE(at(above, 92, 56).paint());
  bodies[0].poses[0].position.z() = -0.1;
  EXPECT_TRUE(at(still({frames, bodies, strips}, style), 92, 56).paint());
}

TEST(Draw, IsTheSameEveryTime) {
  const std::vector<Frame> frames{strip(2, 0.3, 30, 4, 2.0)};
  const std::vector<Body> bodies;
  const std::vector<FlatPattern> strips{pattern(2, 0.3)};
  Style style;
  style.width = 301, style.height = 163;
  style.colour = Colour::energy;
  const Image once = still({frames, bodies, strips}, style), again = still({frames, bodies, strips}, style);
  EXPECT_EQ(once.rgb, again.rgb);
  EXPECT_EQ(once.rgb.size(), 3u * 301 * 163);
}

TEST(Lines, RimsAreEdgesOfOneTriangleThatNoSeamJoins) {
  const Frame frame = strip(1, 0.1, 7, 3);
  std::vector<FlatPattern> strips{pattern(1, 0.1)};
  EXPECT_EQ(rim_edges(frame.surface, strips).size(), 2u * 7 + 2 * 3);
  strips[0].loop = true;
  EXPECT_EQ(rim_edges(frame.surface, strips).size(), 2u * 7);
}

TEST(Lines, RulingsReachFromRimToRim) {
  Frame frame = strip(1, 0.1, 7, 3);
  frame.centerline[3].eta = 0.5;
  const std::vector<Line> lines = rulings_of(frame, {pattern(1, 0.1)});
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_TRUE(lines[3][0].isApprox(Vec3(3.0 / 7 - 0.025, 0.05, 0)));
  EXPECT_TRUE(lines[3][1].isApprox(Vec3(3.0 / 7 + 0.025, -0.05, 0)));
}

}  // namespace
}  // namespace wunderlich::picture
