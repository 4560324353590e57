#include "wunderlich/geometry/chain.hpp"

#include <cassert>

#include "wunderlich/math/four.hpp"

namespace wunderlich::geometry {

namespace {

/// q times the rotation of a fold, which has no component along the normal: (x, y, z, w) (0, f, g, c).
math::Four fold_on(math::Four q, const Fold& fold, double eta) {
  const double f = fold.half_sin * fold.inverse, g = f * eta;
  return math::all(fold.half_cos) * q + math::Four{g, -g, g, -g} * math::swap_pairs(q) +
         math::Four{-f, f, f, -f} * math::swap_halves(q);
}

}  // namespace

void forward_kinematics(const Ribbon& ribbon, const Chain& chain, Kinematics& k) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  k.r.resize(n + 1);
  k.q.resize(n + 1);
  k.frame.resize(n + 1);
  k.fold.resize(n + 1);
  math::Four q{chain.base.frame.x(), chain.base.frame.y(), chain.base.frame.z(), chain.base.frame.w()};
  Vec3 r = chain.base.position;
  for (std::size_t i = 0; i <= n; ++i) {
    k.fold[i] = make_fold(fold_length(ribbon, i), chain.kappa[i], chain.eta[i]);
    if (ribbon.hinge_length[i] > 0) q = fold_on(q, k.fold[i], chain.eta[i]);
    k.q[i] = Quat(q[3], q[0], q[1], q[2]);
    // Now and then a Newton step of 1/sqrt keeps the product of many unit quaternions a unit quaternion.
    if (i % 8 == 0) {
      k.q[i].coeffs() *= 1.5 - 0.5 * k.q[i].squaredNorm();
      q = math::Four{k.q[i].x(), k.q[i].y(), k.q[i].z(), k.q[i].w()};
    }
    k.frame[i] = k.q[i].toRotationMatrix();
    k.r[i] = r;
    if (i < n) r += ribbon.rest_length[i] * k.frame[i].col(2);
  }
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
