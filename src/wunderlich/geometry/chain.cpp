#include "wunderlich/geometry/chain.hpp"

#include <algorithm>
#include <cassert>

namespace wunderlich::geometry {

namespace {

/// q times the rotation of a fold: (x, y, z, w) (0, f, g, c).
math::Four fold_on(math::Four q, double f, double g, double c) {
  return math::all(c) * q + math::Four{g, -g, g, -g} * math::swap_pairs(q) +
         math::Four{-f, f, f, -f} * math::swap_halves(q);
}

/// Rotation matrices of four unit quaternions, the first `count` of which are stored.
void store_frames(const math::Four* q, std::size_t count, Mat3* frames) {
  math::Four x = q[0], y = q[1], z = q[2], w = q[3];
  math::transpose4(x, y, z, w);
  const math::Four x2 = x + x, y2 = y + y, z2 = z + z;
  math::Four columns[3][4] = {{1 - y2 * y - z2 * z, x2 * y + z2 * w, x2 * z - y2 * w, math::all(0)},
                              {x2 * y - z2 * w, 1 - x2 * x - z2 * z, y2 * z + x2 * w, math::all(0)},
                              {x2 * z + y2 * w, y2 * z - x2 * w, 1 - x2 * x - y2 * y, math::all(0)}};
  for (auto& c : columns) math::transpose4(c[0], c[1], c[2], c[3]);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) frames[i].col(c) = math::first_three(columns[c][i]);
  }
}

}  // namespace

void forward_kinematics(const Ribbon& ribbon, const Chain& chain, Kinematics& k) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  k.r.resize(n + 1);
  k.q.resize(n + 1);
  k.frame.resize(n + 1);
  k.fold.resize(n / 4 + 1);
  math::Four q{chain.base.frame.x(), chain.base.frame.y(), chain.base.frame.z(), chain.base.frame.w()};
  for (std::size_t first = 0; first <= n; first += 4) {
    const math::Four eta = math::load(chain.eta, first);
    const Fold<math::Four> fold = make_fold(fold_lengths(ribbon, first), math::load(chain.kappa, first), eta);
    const math::Four f = sine_part(fold), g = f * eta;
    const std::size_t count = std::min<std::size_t>(4, n + 1 - first);
    math::Four block[4] = {q, q, q, q};
    k.fold[first / 4] = fold;
    for (std::size_t j = 0; j < count; ++j) {
      const auto lane = static_cast<int>(j);
      if (ribbon.hinge_length[first + j] > 0) q = fold_on(q, f[lane], g[lane], fold.half_cos[lane]);
      // Now and then a Newton step of 1/sqrt keeps the product of many unit quaternions a unit quaternion.
      if ((first + j) % 8 == 0) q = q * math::all(1.5 - 0.5 * math::dot4(q, q));
      block[j] = q;
      math::store(q, k.q[first + j].coeffs().data());
    }
    store_frames(block, count, k.frame.data() + first);
  }
  k.r[0] = chain.base.position;
  for (std::size_t i = 0; i < n; ++i) k.r[i + 1] = k.r[i] + ribbon.rest_length[i] * k.frame[i].col(2);
}

State state_of(const Ribbon& ribbon, const Chain& chain, double time) {
  Kinematics k;
  forward_kinematics(ribbon, chain, k);
  State state;
  state.time = time;
  state.r = k.r;
  state.r_dot.assign(k.r.size(), Vec3::Zero());
  state.q.assign(k.q.begin(), k.q.end() - 1);
  state.eta = chain.eta;
  state.end_frame = {ribbon.clamped[0] ? chain.base.frame : k.q.front(), k.q.back()};
  return state;
}

Chain chain_of(const Ribbon& ribbon, const State& state) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  assert(state.q.size() == n);
  const Strains strain = strains(ribbon, state);
  Chain chain;
  chain.base = {state.r[0], ribbon.clamped[0] ? state.end_frame[0] : state.q[0]};
  chain.kappa = strain.kappa;
  chain.eta = state.eta;
  for (std::size_t i = 0; i <= n; ++i) {
    if (!kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = 0;
  }
  return chain;
}

Chain straight_chain(const Ribbon& ribbon, const Pose& base) {
  const auto count = static_cast<std::size_t>(ribbon.node_count());
  return {base, std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
}

bool kappa_is_free(const Ribbon& ribbon, int node) { return fold_length(ribbon, static_cast<std::size_t>(node)) > 0; }

bool eta_is_free(const Ribbon& ribbon, int node) {
  const bool is_end = node == 0 || node == ribbon.segments;
  return ribbon.is_loop() || ribbon.free_rulings || !is_end;
}

}  // namespace wunderlich::geometry
