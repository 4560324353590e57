// Friction of strips on themselves and on one another.
#include <cmath>

#include "wunderlich/solver/coulomb.hpp"
#include "wunderlich/solver/self_contact.hpp"

namespace wunderlich::solver {

namespace {

using Strips = std::span<const StripPlace>;

/// Way of one part along the other since the step began.
Vec3 slide_of(const SelfRub& rub, const std::vector<Vec3>& material) {
  Vec3 way = -rub.from;
  for (std::size_t k = 0; k < 4; ++k)
    way += rub.weights[static_cast<Eigen::Index>(k)] * material[static_cast<std::size_t>(rub.corner[k])];
  return way - rub.normal.dot(way) * rub.normal;
}

}  // namespace

void find_material(Strips strips, const SelfContact& problem, std::vector<Vec3>& material) {
  material.clear();
  for (const auto& [ribbon, chain, k] : strips) {
    for (std::size_t i = 0; i < chain.eta.size(); ++i) {
      for (int side = 0; side < 2; ++side) {
        const Vec3& flat = problem.flat[material.size()];
        material.push_back(k.r[i] + flat.y() * k.frame[i].col(1) + (flat.x() - ribbon.node_u[i]) * k.frame[i].col(2));
      }
    }
  }
}

void set_friction(const SelfContacts& contacts, double h, SelfContact& problem) {
  problem.rubs.clear();
  problem.slip = kSlipSpeed * h;
  if (problem.friction == 0) return;
  for (const SelfPair& pair : contacts.pairs) {
    contact::PairPoints x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = contacts.corners[static_cast<std::size_t>(pair.corner[k])];
    const contact::PairNearest nearest = contact::pair_nearest(pair.kind, x);
    const contact::PairEnergy energy = contact::pair_energy(pair.kind, x, gap_of(problem, pair));
    SelfRub rub{pair.corner, nearest.weights, nearest.way / nearest.distance, nearest.way, 0};
    // All that acts on the first part. What weakens pairs of edges near parallel turns them, and adds nothing.
    Vec3 force = energy.gradient.head<3>();
    if (pair.kind == contact::PairKind::edge_edge) force += energy.gradient.segment<3>(3);
    rub.force = problem.friction * problem.stiffness * std::abs(force.dot(rub.normal));
    problem.rubs.push_back(rub);
  }
}

double friction_value(const SelfContact& problem, const SelfContacts& contacts) {
  double sum = 0;
  for (const SelfRub& rub : problem.rubs)
    sum += rub.force * sliding_value(slide_of(rub, contacts.material).norm(), problem.slip);
  return sum;
}

void add_self_friction(Strips strips, const SelfContact& problem, const SelfContacts& contacts, bool settled,
                       std::span<math::ChainSystem* const> systems, std::vector<math::ChainCoupling>& between) {
  if (problem.rubs.empty()) return;
  CornerSums sums;
  clear(contacts.material.size(), sums);
  const contact::Mat12 none = contact::Mat12::Zero();
  for (const SelfRub& rub : problem.rubs) {
    const Vec3 slide = slide_of(rub, contacts.material);
    const double way = slide.norm();
    const Vec3 onward = way > 0 ? Vec3((1 / way) * slide) : rub.normal.unitOrthogonal();
    const Vec3 beside = rub.normal.cross(onward);
    const Pull pull = pull_of(way, problem.slip, settled);
    contact::Vec12 along, across;
    for (Eigen::Index k = 0; k < 4; ++k) {
      along.segment<3>(3 * k) = rub.weights[k] * onward;
      across.segment<3>(3 * k) = rub.weights[k] * beside;
    }
    const contact::Mat12 hessian =
        rub.force * (pull.along * along * along.transpose() + pull.across * across * across.transpose());
    add(rub.corner, rub.force * pull.across * way * along, hessian, none, sums);
  }
  hand_over(strips, sums, contacts.material, true, systems, between);
}

}  // namespace wunderlich::solver
