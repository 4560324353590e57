/// Which of many things are near each other: those whose boxes overlap, found by a tree of boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::contact {

/// A box along the axes [m].
struct Extent {
  Vec3 low, high;

  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Extent& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  void widen(double by) {
    low.array() -= by;
    high.array() += by;
  }
  /// Touching counts.
  bool overlaps(const Extent& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Distance between two boxes, 0 where they overlap [m].
inline double apart(const Extent& a, const Extent& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).norm();
}

/// Where coordinates are whole numbers from 0 to 2^20 - 1; what is outside is at its border.
struct Grid {
  Vec3 low = Vec3::Zero();    ///< [m]
  Vec3 cells = Vec3::Zero();  ///< in a metre, 0 where everything lies in one plane
};

/// A box in whole numbers: three to a word, each with a bit to spare above it, so that they are compared at once.
struct GridBox {
  std::uint64_t low, high;
};

/// Items along a curve that fills space, so that those near in it are near in space, below a binary tree of the boxes
/// of 2, 4, 8, ... neighbours. Its arrays are kept when it is built again.
struct ExtentTree {
  Grid grid;
  std::vector<Extent> items;         ///< along the curve
  std::vector<GridBox> boxes;        ///< of the items
  std::vector<int> order;            ///< which item of the input each is
  std::vector<GridBox> nodes;        ///< children of i at 2i and 2i + 1, root at 1; the last half are leaves
  int levels = 0;                    ///< of nodes above the leaves
  std::vector<GridBox> given_boxes;  ///< in the order of the input
  std::vector<std::uint64_t> keys;   ///< place on the curve and index, to sort by
  std::vector<std::uint64_t> spare;
};

/// The grid over all of them.
Grid grid_over(const std::vector<Extent>& extents);

/// Linear in the number of items. Those that are not numbers overlap nothing. The grid decides about speed alone.
void build_tree(const std::vector<Extent>& extents, const Grid& grid, ExtentTree& tree);

/// Indices of two items.
using Near = std::array<int, 2>;

/// All pairs of items that overlap, the smaller index first, each once; replaces what was in `pairs`. Their order
/// depends on the extents alone.
void find_near(const ExtentTree& tree, std::vector<Near>& pairs);

/// All pairs of one item of each tree that overlap. Both must have been built with the same grid.
void find_near(const ExtentTree& first, const ExtentTree& second, std::vector<Near>& pairs);

}  // namespace wunderlich::contact
