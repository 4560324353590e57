// The measure by which models are compared: exact on surfaces whose strains are known.
#include "wunderlich/geometry/isometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/chains.hpp"

namespace wunderlich::geometry {
namespace {

/// A flat grid moved by `map`.
template <class Map>
StripGrid mapped(int along, int across, double length, double width, Map map) {
  StripGrid grid{along, across, {}, {}};
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= across; ++j) {
      const Vec2 flat(length * i / along, width * (static_cast<double>(j) / across - 0.5));
      grid.flat.push_back(flat);
      grid.points.push_back(map(flat));
    }
  }
  return grid;
}

TEST(Isometry, OfASimpleShearIsItsDiagonals) {
  const double shear = 0.03;
  const auto grid = mapped(7, 3, 1, 0.2, [&](const Vec2& f) { return Vec3(f.x() + shear * f.y(), f.y(), 0); });
  const IsometryErrors errors = isometry_errors(grid);
  EXPECT_NEAR(errors.area, 0, 1e-14);
  EXPECT_NEAR(errors.rim, 0, 1e-14);
  EXPECT_NEAR(errors.diagonal, std::sqrt(0.5 * ((1 + shear) * (1 + shear) + 1)) - 1, 1e-14);
}

TEST(Isometry, OfAStretchIsItself) {
  const auto grid = mapped(5, 2, 1, 0.2, [](const Vec2& f) { return Vec3(1.01 * f.x(), 0, f.y()); });
  const IsometryErrors errors = isometry_errors(grid);
  EXPECT_NEAR(errors.area, 0.01, 1e-14);
  EXPECT_NEAR(errors.rim, 0.01, 1e-14);
}

TEST(Isometry, OfAHelicoidHasTheAreaAndRimOfItsFormula) {
  // Area: mean of sqrt(1 + (t v)^2) over v; rim: the same at v = w/2, with the twist t per length.
  const double t = 3.0, w = 0.4;
  const auto grid = mapped(2000, 200, 1, w, [&](const Vec2& f) {
    return Vec3(f.x(), f.y() * std::cos(t * f.x()), f.y() * std::sin(t * f.x()));
  });
  const double a = 0.5 * t * w;
  const double area = 0.5 * (std::sqrt(1 + a * a) + std::asinh(a) / a) - 1;
  EXPECT_NEAR(isometry_errors(grid).area, area, 1e-5);
  EXPECT_NEAR(isometry_errors(grid).rim, std::sqrt(1 + a * a) - 1, 1e-5);
}

TEST(Isometry, OfTheRibbonIsExact) {
  RibbonSpec spec;
  spec.segments = 30;
  const Ribbon ribbon = make_ribbon(spec);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto [kappa, eta] = testing::random_strains(ribbon, 0.9, seed);
    const IsometryErrors errors = isometry_errors(facet_grid(ribbon, testing::hinged_chain(ribbon, kappa, eta), 4));
    EXPECT_LT(std::abs(errors.area), 1e-12);
    EXPECT_LT(std::abs(errors.diagonal), 1e-9);
    EXPECT_LT(std::abs(errors.rim), 1e-12);
  }
}

}  // namespace
}  // namespace wunderlich::geometry
