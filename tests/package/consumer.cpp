// Uses the installed headers and library: a straight strip has its nominal area.
#include <cmath>

#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/geometry/surface.hpp"

int main() {
  namespace geometry = wunderlich::geometry;
  geometry::RibbonSpec spec;
  spec.length = 2;
  spec.width = 0.25;
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  const double area = geometry::surface_area(ribbon, geometry::straight_state(ribbon));
  return std::abs(area - 0.5) < 1e-12 ? 0 : 1;
}
