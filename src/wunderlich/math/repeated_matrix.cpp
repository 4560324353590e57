#include "wunderlich/math/repeated_matrix.hpp"

#include <algorithm>

namespace wunderlich::math {

void RepeatedMatrix::note(int size) {
  noting_ = true;
  size_ = size;
  entries_.clear();
}

void RepeatedMatrix::repeat() {
  noting_ = false;
  next_ = 0;
  std::fill(lower_.valuePtr(), lower_.valuePtr() + lower_.nonZeros(), 0.0);
}

void RepeatedMatrix::add(int row, int column, double value) {
  if (noting_) {
    entries_.emplace_back(std::max(row, column), std::min(row, column), value);
  } else {
    lower_.valuePtr()[slot_[next_++]] += value;
  }
}

void RepeatedMatrix::settle() {
  lower_.resize(size_, size_);
  lower_.setFromTriplets(entries_.begin(), entries_.end());
  slot_.clear();
  for (const auto& entry : entries_) {
    const int* first = lower_.innerIndexPtr() + lower_.outerIndexPtr()[entry.col()];
    const int* last = lower_.innerIndexPtr() + lower_.outerIndexPtr()[entry.col() + 1];
    slot_.push_back(static_cast<int>(std::lower_bound(first, last, entry.row()) - lower_.innerIndexPtr()));
  }
}

}  // namespace wunderlich::math
