#include "wunderlich/contact/near_pairs.hpp"

#include <algorithm>
#include <cassert>

namespace wunderlich::contact {

namespace {

constexpr std::size_t kLeafItems = 16;
constexpr int kKeyBits = 30;  // ten a coordinate: cells of a thousandth of the whole
constexpr int kDigitBits = 10;

constexpr int kGridBits = 20;
constexpr int kField = kGridBits + 1;  // and the spare bit
constexpr std::uint64_t kMask = (std::uint64_t{1} << kGridBits) - 1;
constexpr std::uint64_t kSpares = std::uint64_t{1} << kGridBits | std::uint64_t{1} << (kGridBits + kField) |
                                  std::uint64_t{1} << (kGridBits + 2 * kField);

std::uint64_t field(std::uint64_t word, int k) { return word >> (k * kField) & kMask; }

/// Comparisons fail for what is no number: it goes to 0.
std::uint64_t grid_point(const Grid& grid, const Vec3& x) {
  std::uint64_t word = 0;
  for (int k = 0; k < 3; ++k) {
    const double cell = (x[k] - grid.low[k]) * grid.cells[k];
    const std::uint64_t whole = cell > 0 ? static_cast<std::uint64_t>(std::min(cell, static_cast<double>(kMask))) : 0;
    word |= whole << (k * kField);
  }
  return word;
}

/// A difference keeps its spare bit where nothing had to be borrowed: where the first is not below the second.
bool overlap(const GridBox& a, const GridBox& b) {
  return (((b.high | kSpares) - a.low) & ((a.high | kSpares) - b.low) & kSpares) == kSpares;
}

GridBox joined(const GridBox& a, const GridBox& b) {
  GridBox both{0, 0};
  for (int k = 0; k < 3; ++k) {
    both.low |= std::min(field(a.low, k), field(b.low, k)) << (k * kField);
    both.high |= std::max(field(a.high, k), field(b.high, k)) << (k * kField);
  }
  return both;
}

/// Every third bit from the ten lowest.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

/// The middle's coordinates in turns, a bit each: the place on a curve that fills the whole (Morton's).
std::uint64_t place_on_curve(const GridBox& box) {
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) key |= spread((field(box.low, k) + field(box.high, k)) >> (kGridBits + 1 - 10)) << k;
  return key;
}

/// By their lowest thirty bits, stable: three passes over digits.
void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& spare) {
  spare.resize(keys.size());
  for (int shift = 0; shift < kKeyBits; shift += kDigitBits) {
    std::array<std::uint32_t, (1u << kDigitBits) + 1> begin{};
    const auto digit = [&](std::uint64_t key) { return (key >> shift) & ((1u << kDigitBits) - 1); };
    for (const std::uint64_t key : keys) ++begin[digit(key) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    for (const std::uint64_t key : keys) spare[begin[digit(key)]++] = key;
    keys.swap(spare);
  }
}

void sort_items(const std::vector<Extent>& extents, ExtentTree& tree) {
  const std::size_t n = extents.size();
  tree.given_boxes.resize(n);
  tree.keys.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    tree.given_boxes[i] = {grid_point(tree.grid, extents[i].low), grid_point(tree.grid, extents[i].high)};
    tree.keys[i] = place_on_curve(tree.given_boxes[i]) | static_cast<std::uint64_t>(i) << kKeyBits;
  }
  sort_keys(tree.keys, tree.spare);
  tree.items.resize(n);
  tree.boxes.resize(n);
  tree.order.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t index = tree.keys[i] >> kKeyBits;
    tree.items[i] = extents[index];
    tree.boxes[i] = tree.given_boxes[index];
    tree.order[i] = static_cast<int>(index);
  }
}

std::size_t leaf_count(const ExtentTree& tree) { return tree.nodes.size() / 2; }

/// Where the items of a leaf begin; those of the one before end there.
std::size_t leaf_begin(const ExtentTree& tree, std::size_t node) {
  return ((node - leaf_count(tree)) * tree.items.size()) >> tree.levels;
}

/// Walks down both trees where their boxes overlap.
struct Walk {
  const ExtentTree& first;
  const ExtentTree& second;
  std::vector<Near>& pairs;

  void add(std::size_t i, std::size_t j) const {
    const int a = first.order[i], b = second.order[j];
    if (&first == &second) {
      pairs.push_back({std::min(a, b), std::max(a, b)});
    } else {
      pairs.push_back({a, b});
    }
  }

  void leaves(std::size_t a, std::size_t b) const {
    const std::size_t end_a = leaf_begin(first, a + 1), begin_b = leaf_begin(second, b);
    const std::size_t end_b = leaf_begin(second, b + 1);
    const GridBox all_b = second.nodes[b];
    for (std::size_t i = leaf_begin(first, a); i < end_a; ++i) {
      const GridBox box = first.boxes[i];
      if (!overlap(box, all_b)) continue;
      // Without a branch for each: whether boxes overlap is not to be foreseen.
      std::array<std::size_t, 2 * kLeafItems> hits;
      std::size_t count = 0;
      for (std::size_t j = begin_b; j < end_b; ++j) {
        hits[count] = j;
        count += overlap(box, second.boxes[j]) ? 1 : 0;
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (first.items[i].overlaps(second.items[hits[k]])) add(i, hits[k]);
      }
    }
  }

  void both(std::size_t a, std::size_t b) const {
    if (!overlap(first.nodes[a], second.nodes[b])) return;
    const bool leaf_a = a >= leaf_count(first), leaf_b = b >= leaf_count(second);
    if (leaf_a && leaf_b) return leaves(a, b);
    for (std::size_t i = leaf_a ? a : 2 * a; i <= (leaf_a ? a : 2 * a + 1); ++i) {
      for (std::size_t j = leaf_b ? b : 2 * b; j <= (leaf_b ? b : 2 * b + 1); ++j) both(i, j);
    }
  }

  void itself(std::size_t a) const {
    if (a < leaf_count(first)) {
      itself(2 * a);
      itself(2 * a + 1);
      both(2 * a, 2 * a + 1);
      return;
    }
    const std::size_t end = leaf_begin(first, a + 1);
    for (std::size_t i = leaf_begin(first, a); i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        if (overlap(first.boxes[i], first.boxes[j]) && first.items[i].overlaps(first.items[j])) add(i, j);
      }
    }
  }
};

}  // namespace

Grid grid_over(const std::vector<Extent>& extents) {
  Grid grid;
  if (extents.empty()) return grid;
  Extent whole = extents.front();
  for (const Extent& extent : extents) whole.add(extent);
  const Vec3 size = whole.high - whole.low;
  grid.low = whole.low;
  for (int k = 0; k < 3; ++k) grid.cells[k] = size[k] > 0 ? static_cast<double>(kMask + 1) / size[k] : 0;
  return grid;
}

void build_tree(const std::vector<Extent>& extents, const Grid& grid, ExtentTree& tree) {
  tree.grid = grid;
  tree.items.clear();
  tree.nodes.clear();
  if (extents.empty()) return;
  sort_items(extents, tree);
  tree.levels = 0;
  while (kLeafItems << tree.levels < extents.size()) ++tree.levels;
  const std::size_t leaves = std::size_t{1} << tree.levels;
  tree.nodes.resize(2 * leaves);
  for (std::size_t node = leaves; node < 2 * leaves; ++node) {
    const std::size_t begin = leaf_begin(tree, node), end = leaf_begin(tree, node + 1);
    tree.nodes[node] = tree.boxes[begin];
    for (std::size_t i = begin + 1; i < end; ++i) tree.nodes[node] = joined(tree.nodes[node], tree.boxes[i]);
  }
  for (std::size_t node = leaves; node-- > 1;)
    tree.nodes[node] = joined(tree.nodes[2 * node], tree.nodes[2 * node + 1]);
}

void find_near(const ExtentTree& tree, std::vector<Near>& pairs) {
  pairs.clear();
  if (!tree.items.empty()) Walk{tree, tree, pairs}.itself(1);
}

void find_near(const ExtentTree& first, const ExtentTree& second, std::vector<Near>& pairs) {
  assert(first.grid.low == second.grid.low && first.grid.cells == second.grid.cells);
  pairs.clear();
  if (!first.items.empty() && !second.items.empty()) Walk{first, second, pairs}.both(1, 1);
}

}  // namespace wunderlich::contact
