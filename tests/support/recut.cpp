#include "support/recut.hpp"

namespace wunderlich::testing {

using geometry::Ribbon;
using geometry::State;

Ribbon recut(const Ribbon& ribbon, int node) {
  geometry::RibbonSpec spec;
  spec.length = ribbon.length;
  spec.width = ribbon.width;
  spec.segments = ribbon.segments;
  spec.bending_stiffness = ribbon.bending_stiffness;
  spec.area_density = ribbon.area_density;
  spec.closure = ribbon.closure;
  spec.half_twists = ribbon.half_twists;
  for (int s = 0; s < ribbon.segments; ++s) {
    spec.spacing.push_back(ribbon.rest_length[static_cast<std::size_t>((s + node) % ribbon.segments)]);
  }
  return make_ribbon(spec);
}

State recut(const Ribbon& ribbon, const State& state, int node) {
  State out = state;
  for (int k = 0; k <= ribbon.segments; ++k) {
    const auto to = static_cast<std::size_t>(k), from = static_cast<std::size_t>((k + node) % ribbon.segments);
    const bool beyond = k + node >= ribbon.segments;
    out.r[to] = state.r[from];
    out.r_dot[to] = state.r_dot[from];
    out.eta[to] = (beyond ? ribbon.seam_sign() : 1) * state.eta[from];
    if (k < ribbon.segments) out.q[to] = beyond ? across_seam(ribbon, state.q[from]) : state.q[from];
  }
  return out;
}

}  // namespace wunderlich::testing
