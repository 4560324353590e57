/// Forces on the corners of strips and second derivatives between them, as pairs of corners add them up.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "wunderlich/contact/pair.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::solver {

/// A strip as it lies.
struct StripPlace {
  const geometry::Ribbon& ribbon;
  const geometry::Chain& chain;
  const geometry::Kinematics& kinematics;
};

/// Corner 2i + side of node i, those of a further strip after those of the strips before it.
struct CornerSums {
  struct Block {
    Mat3 hessian, geometric;
  };
  std::vector<Vec3> force;  ///< gradient in the place of each corner [N]
  std::vector<std::array<int, 2>> corners;
  std::vector<Block> blocks;  ///< of these two corners, the first of them not after the second
};

/// Sums of nothing, for so many corners.
void clear(std::size_t corners, CornerSums& sums);

/// Adds a gradient and both parts of a Hessian in the places of four corners.
void add(const std::array<int, 4>& corner, const contact::Vec12& gradient, const contact::Mat12& hessian,
         const contact::Mat12& geometric, CornerSums& sums);

/// Adds the sums to the strips' systems, and to `between` what corners of two strips do to each other. `at`: where the
/// corners are. Those that are `frozen` stay where they are on their links, others go with their rulings.
void hand_over(std::span<const StripPlace> strips, const CornerSums& sums, const std::vector<Vec3>& at, bool frozen,
               std::span<math::ChainSystem* const> systems, std::vector<math::ChainCoupling>& between);

}  // namespace wunderlich::solver
