#include "wunderlich/geometry/ribbon.hpp"

#include <cassert>
#include <numeric>

namespace wunderlich::geometry {

namespace {

std::vector<double> rest_lengths(const RibbonSpec& spec) {
  const auto n = static_cast<std::size_t>(spec.segments);
  if (spec.spacing.empty()) return std::vector<double>(n, spec.length / spec.segments);
  assert(spec.spacing.size() == n);
  const double sum = std::accumulate(spec.spacing.begin(), spec.spacing.end(), 0.0);
  std::vector<double> lengths = spec.spacing;
  for (double& l : lengths) l *= spec.length / sum;
  return lengths;
}

}  // namespace

Ribbon make_ribbon(const RibbonSpec& spec) {
  assert(spec.segments >= 2 && spec.length > 0 && spec.width > 0);
  Ribbon ribbon;
  ribbon.length = spec.length;
  ribbon.width = spec.width;
  ribbon.bending_stiffness = spec.bending_stiffness;
  ribbon.area_density = spec.area_density;
  ribbon.segments = spec.segments;
  ribbon.closure = spec.closure;
  ribbon.half_twists = spec.closure == Closure::loop ? spec.half_twists : 0;
  ribbon.clamped = spec.closure == Closure::loop ? std::array<bool, 2>{} : spec.clamped;
  ribbon.free_rulings = spec.free_rulings;
  ribbon.rest_length = rest_lengths(spec);

  const auto& l = ribbon.rest_length;
  const std::size_t n = l.size();
  ribbon.node_u.assign(n + 1, 0.0);
  std::partial_sum(l.begin(), l.end(), ribbon.node_u.begin() + 1);
  ribbon.hinge_length.assign(n + 1, 0.0);
  ribbon.node_mass.assign(n + 1, 0.0);
  const double line_density = spec.area_density * spec.width;
  for (std::size_t i = 1; i < n; ++i) ribbon.hinge_length[i] = 0.5 * (l[i - 1] + l[i]);
  for (std::size_t s = 0; s < n; ++s) {
    ribbon.node_mass[s] += 0.5 * line_density * l[s];
    ribbon.node_mass[s + 1] += 0.5 * line_density * l[s];
  }
  if (ribbon.is_loop()) {
    ribbon.hinge_length[n] = 0.5 * (l[n - 1] + l[0]);
    ribbon.node_mass[0] += ribbon.node_mass[n];
    ribbon.node_mass[n] = 0;
  } else {
    if (ribbon.clamped[0]) ribbon.hinge_length[0] = 0.5 * l[0];
    if (ribbon.clamped[1]) ribbon.hinge_length[n] = 0.5 * l[n - 1];
  }
  return ribbon;
}

Quat across_seam(const Ribbon& ribbon, const Quat& frame) {
  // A half turn about d3 is the quaternion (0, 0, 1, 0); two of them are -1, the same rotation.
  return ribbon.half_twists % 2 == 0 ? frame : frame * Quat(0, 0, 0, 1);
}

}  // namespace wunderlich::geometry
