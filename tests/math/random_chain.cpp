#include "math/random_chain.hpp"

#include <algorithm>

namespace wunderlich::testing {

using Eigen::Index;
using math::ChainRow;
using math::ChainSystem;

ChainSystem random_system(int links, const std::array<bool, 6>& base_fixed, double softness, Random& random) {
  ChainSystem system;
  system.base_fixed = base_fixed;
  system.geometric = false;
  system.shift = {0.1 * std::abs(random()), 0.1 * std::abs(random())};
  for (int i = 0; i <= links; ++i) {
    math::ChainLink link;
    for (math::Four* vector : {&link.axis[0], &link.axis[1], &link.axis_01, &link.axis_11, &link.span, &link.force})
      *vector = math::four(random.vector());
    link.stiffness = std::abs(random());
    link.chart = 0.05 * random();
    link.grad_a = random.pair();
    link.grad_b = random.pair();
    const Mat4 h = random.symmetric(4, softness);
    link.hess_aa = h.topLeftCorner<2, 2>();
    link.hess_ab = h.topRightCorner<2, 2>();
    link.hess_bb = h.bottomRightCorner<2, 2>();
    system.links.push_back(link);
  }
  for (int i = 0; i < links; ++i) {
    const Vec3 force = random.vector();
    const Mat3 hessian = random.symmetric(3, softness), geometric = random.symmetric(3, softness);
    math::TurnTerm term;
    for (int a = 0; a < 3; ++a) {
      term.hessian[a] = math::four(hessian.row(a), force[a]);
      term.geometric[a] = math::four(geometric.row(a));
    }
    system.turns.push_back(term);
  }
  for (int node = links - 1; node >= 0; node -= 2) {
    math::SurfaceTerm term;
    term.node = node;
    for (Index k = 0; k < 8; ++k) term.gradient[k] = random();
    term.hessian = 0.03 * random.symmetric(8, 8 * softness);
    system.surfaces.push_back(term);
  }
  for (const int node : {links, links / 2, 0}) {
    math::PoseTerm term;
    term.node = node;
    term.gradient << random.vector(), random.vector();
    term.hessian = random.symmetric(6, softness);
    system.pose_terms.push_back(term);
  }
  return system;
}

void add_random_rows(int count, Random& random, ChainSystem& system) {
  const int last = static_cast<int>(system.links.size()) - 1;
  for (int k = 0; k < count; ++k) {
    ChainRow row;
    row.node = k < 3 ? last : last - (k % (last + 1));
    row.v = random.vector();
    row.theta = random.vector();
    row.residual = random();
    row.multiplier = random();
    if (k % 2 == 0) {
      row.penalty = 10 * std::abs(random());
    } else {
      row.u = random.pair();
      row.base_v = random.vector();
      row.base_theta = random.vector();
      row.first_u = random.pair();
    }
    system.rows.push_back(row);
  }
  std::stable_sort(system.rows.begin(), system.rows.end(), [](auto& a, auto& b) { return a.node > b.node; });
}

}  // namespace wunderlich::testing
