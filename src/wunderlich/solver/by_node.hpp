/// Lists that the sweep walks from the last node to the first. Internal to solver/.
#pragma once

#include <algorithm>
#include <vector>

namespace wunderlich::solver {

/// Keeps the items sorted by decreasing node, those of one node in the order they came.
template <class Item>
void insert_by_node(const Item& item, std::vector<Item>& items) {
  const auto after =
      std::upper_bound(items.begin(), items.end(), item, [](const Item& a, const Item& b) { return a.node > b.node; });
  items.insert(after, item);
}

}  // namespace wunderlich::solver
