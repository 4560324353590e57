#include "wunderlich/solver/corner_sums.hpp"

#include <algorithm>

namespace wunderlich::solver {

using Strips = std::span<const StripPlace>;
using Systems = std::span<math::ChainSystem* const>;

namespace {

/// A pair of corners as one number, and where its block is.
struct Keyed {
  std::uint64_t key;
  std::size_t block;
  bool operator<(const Keyed& other) const { return key != other.key ? key < other.key : block < other.block; }
};

/// Where a corner is among the points of its chain.
struct PointPlace {
  int chain = -1, point = -1;
};

PointPlace add_point(Strips strips, const CornerSums& sums, const std::vector<Vec3>& at, bool frozen, int corner,
                     Systems systems) {
  std::size_t strip = 0;
  int node = corner / 2;
  while (node >= static_cast<int>(strips[strip].chain.eta.size()))
    node -= static_cast<int>(strips[strip++].chain.eta.size());
  const auto& [ribbon, rulings, k] = strips[strip];
  const auto i = static_cast<std::size_t>(node), c = static_cast<std::size_t>(corner);
  const double v = (corner % 2 == 0 ? -0.5 : 0.5) * ribbon.width;
  const bool turns = !frozen && geometry::eta_is_free(ribbon, node);
  const Vec3 slant = turns ? Vec3(v * k.frame[i].col(2)) : Vec3::Zero();
  auto& points = systems[strip]->points;
  points.push_back({node, at[c] - k.r[i], slant, sums.force[c]});
  return {static_cast<int>(strip), static_cast<int>(points.size()) - 1};
}

}  // namespace

void clear(std::size_t corners, CornerSums& sums) {
  sums.force.assign(corners, Vec3::Zero());
  sums.corners.clear();
  sums.blocks.clear();
}

void add(const std::array<int, 4>& corner, const contact::Vec12& gradient, const contact::Mat12& hessian,
         const contact::Mat12& geometric, CornerSums& sums) {
  for (std::size_t a = 0; a < 4; ++a) {
    const auto row = 3 * static_cast<Eigen::Index>(a);
    sums.force[static_cast<std::size_t>(corner[a])] += gradient.segment<3>(row);
    for (std::size_t b = 0; b < 4; ++b) {
      const auto column = 3 * static_cast<Eigen::Index>(b);
      if (corner[a] > corner[b]) continue;
      sums.corners.push_back({corner[a], corner[b]});
      sums.blocks.push_back({hessian.block<3, 3>(row, column), geometric.block<3, 3>(row, column)});
    }
  }
}

void hand_over(Strips strips, const CornerSums& sums, const std::vector<Vec3>& at, bool frozen, Systems systems,
               std::vector<math::ChainCoupling>& between) {
  std::vector<Keyed> order(sums.blocks.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& [a, b] = sums.corners[i];
    order[i] = {static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b), i};
  }
  std::sort(order.begin(), order.end());
  std::vector<PointPlace> place(sums.force.size());
  const auto placed = [&](int corner) {
    PointPlace& p = place[static_cast<std::size_t>(corner)];
    if (p.chain < 0) p = add_point(strips, sums, at, frozen, corner, systems);
    return p;
  };
  for (std::size_t i = 0; i < order.size();) {
    CornerSums::Block sum = sums.blocks[order[i].block];
    const auto [corner_a, corner_b] = sums.corners[order[i].block];
    const std::uint64_t key = order[i].key;
    for (++i; i < order.size() && order[i].key == key; ++i) {
      sum.hessian += sums.blocks[order[i].block].hessian;
      sum.geometric += sums.blocks[order[i].block].geometric;
    }
    const PointPlace a = placed(corner_a), b = placed(corner_b);
    const math::PointCoupling coupling{a.point, b.point, sum.hessian, sum.geometric};
    if (a.chain == b.chain) {
      systems[static_cast<std::size_t>(a.chain)]->couplings.push_back(coupling);
    } else {
      between.push_back({{a.chain, b.chain}, coupling});
    }
  }
}

}  // namespace wunderlich::solver
