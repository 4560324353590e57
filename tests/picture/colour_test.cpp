#include "wunderlich/picture/colour.hpp"

#include "picture/sample.hpp"
#include "support/input_error.hpp"

namespace wunderlich::picture {
namespace {

using testing::strip;
using wunderlich::testing::input_error;

TEST(Colour, ScreensAndLightAreInverse) {
  for (int k = 0; k <= 255; ++k) {
    const float srgb = static_cast<float>(k) / 255;
    EXPECT_NEAR(srgb_of(linear_of(srgb)), srgb, 1e-6);
  }
  EXPECT_NEAR(linear_of(0.5f), 0.21404f, 1e-5);  // IEC 61966-2-1
}

TEST(Colour, IsBlueBelowAndRedAbove) {
  const auto low = colour_of(-2), middle = colour_of(0), high = colour_of(1);
  EXPECT_TRUE(low.isApprox(linear_of(0x05488fu)));
  EXPECT_TRUE(middle.isApprox(linear_of(0xf3f0ebu)));
  EXPECT_TRUE(high.isApprox(linear_of(0x960c26u)));
  EXPECT_EQ(share_of(-3, 6, Colour::kappa), -0.5);
  EXPECT_EQ(share_of(9, 4, Colour::energy), 1.5);
}

TEST(Field, EnergyIsThePrincipalCurvatureSquared) {
  // @eq Shen2015:3: kappa (1 + eta^2) / (1 + v eta') with eta linear between nodes. Two strips, one behind the other.
  Frame frame = strip(2, 0.5, 4, 2, 0.8);
  Mesh& mesh = frame.surface;
  const std::size_t one = mesh.points.size();
  for (std::size_t i = 0; i < one; ++i) mesh.fields[4].values[i] = 0.3 * mesh.fields[0].values[i];
  for (CenterlineSample& sample : frame.centerline) sample.eta = 0.3 * sample.u;
  const Frame plain = strip(2, 0.5, 4, 2, 1.7);
  for (std::size_t f = 0; f < 5; ++f) {
    const auto& more = plain.surface.fields[f].values;
    mesh.fields[f].values.insert(mesh.fields[f].values.end(), more.begin(), more.end());
  }
  mesh.points.insert(mesh.points.end(), plain.surface.points.begin(), plain.surface.points.end());
  mesh.fields.push_back({"ribbon", "", std::vector<double>(one, 0.0)});
  mesh.fields.back().values.resize(mesh.points.size(), 1.0);
  for (CenterlineSample sample : plain.centerline) {
    sample.ribbon = 1;
    frame.centerline.push_back(sample);
  }
  const std::vector<double> energy = field_of(frame, Colour::energy);
  for (std::size_t i = 0; i < one; ++i) {
    const double eta = mesh.fields[4].values[i], v = mesh.fields[1].values[i];
    const double principal = 0.8 * (1 + eta * eta) / (1 + 0.3 * v);
    EXPECT_NEAR(energy[i], principal * principal, 1e-12);
  }
  for (std::size_t i = one; i < energy.size(); ++i) EXPECT_NEAR(energy[i], 1.7 * 1.7, 1e-12);
}

TEST(Field, ASpikeDoesNotSetTheRange) {
  Frame frame = strip(1, 0.1, 999, 1, 0.5);
  frame.surface.fields[2].values[7] = 1e6;
  EXPECT_NEAR(range_of({&frame}, Colour::kappa), 0.5, 1e-12);
  EXPECT_EQ(range_of({&frame}, Colour::tau), 1) << "of a field that is zero";
  for (double& kappa : frame.surface.fields[2].values) kappa = 3e-16;
  EXPECT_EQ(range_of({&frame}, Colour::kappa), 1) << "of rounding";
}

TEST(Style, ReadsWhatIsRightAndRefusesTheRest) {
  Style style;
  parse_size("640x480", style);
  EXPECT_EQ(style.width, 640);
  EXPECT_EQ(style.height, 480);
  EXPECT_NEAR(parse_direction("90,-45").azimuth, M_PI / 2, 1e-12);
  EXPECT_NEAR(parse_direction("370,-45").azimuth, M_PI / 18, 1e-12);
  EXPECT_EQ(parse_colour("eta"), Colour::eta);
  for (const char* bad : {"", "640", "640x", "x480", "640x480x3", "0x480", "15x480", "8193x480", "-640x480", "1e3x480",
                          "99999999999x480", "640 x 480"}) {
    EXPECT_NE(input_error([&] { parse_size(bad, style); }).find("WIDTHxHEIGHT"), std::string::npos) << bad;
  }
  for (const char* bad : {"", "30", "30,", ",20", "30,91", "nan,0", "inf,0", "30,20,10", "left,up"}) {
    EXPECT_NE(input_error([&] { parse_direction(bad); }).find("AZIMUTH,ELEVATION"), std::string::npos) << bad;
  }
  EXPECT_NE(input_error([&] { parse_colour("red"); }).find("plain, kappa, tau, eta, energy"), std::string::npos);
}

}  // namespace
}  // namespace wunderlich::picture
