#include "wunderlich/solver/two_stage/flat_region.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// Share of the bound 2/w on |eta'| that the rule uses: the log energy is infinite at the bound.
constexpr double kBoundShare = 0.9;

bool is_flat(const Ribbon& ribbon, double flat_curvature, const Workspace& work, std::size_t node) {
  const NodeView& view = work.views[node];
  if (view.hinge < 0) return false;  // a free end: its ruling is given, or free for the minimiser
  return std::abs(work.strain[static_cast<std::size_t>(view.hinge)][1]) * ribbon.width < flat_curvature;
}

/// Rulings first + 1 ... last - 1, those at first and last being given. The smallest |eta| between the two cones of
/// slope 2/w that open at the ends.
int flatten_run(const Ribbon& ribbon, std::size_t first, std::size_t last, geometry::State& shape) {
  const double a = shape.eta[first], b = shape.eta[last], ua = ribbon.node_u[first], ub = ribbon.node_u[last];
  const double slope = kBoundShare * 2 / ribbon.width;
  if (std::abs(b - a) > slope * (ub - ua)) return 0;  // steeper than the rule may be: left to the minimiser
  int changed = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double up = slope * (ribbon.node_u[i] - ua), down = slope * (ub - ribbon.node_u[i]);
    const double eta = std::clamp(0.0, std::max(a - up, b - down), std::min(a + up, b + down));
    changed += eta != shape.eta[i];
    shape.eta[i] = eta;
  }
  return changed;
}

}  // namespace

int flatten_rulings(const Ribbon& ribbon, double flat_curvature, geometry::State& shape, const Workspace& work) {
  int changed = 0;
  const std::size_t nodes = shape.eta.size();
  for (std::size_t first = 0; first + 1 < nodes;) {
    std::size_t last = first + 1;
    while (last + 1 < nodes && is_flat(ribbon, flat_curvature, work, last)) ++last;
    changed += flatten_run(ribbon, first, last, shape);
    first = last;
  }
  return changed;
}

}  // namespace wunderlich::solver::two_stage
