#include "wunderlich/math/banded.hpp"

#include <algorithm>
#include <cmath>

namespace wunderlich::math {

void BandedMatrix::reset(int new_size, int new_bandwidth) {
  size = new_size;
  bandwidth = new_bandwidth;
  lower.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(bandwidth + 1), 0.0);
}

Inertia factor(BandedMatrix& matrix) {
  Inertia inertia;
  const int stride = matrix.bandwidth + 1;
  for (int j = 0; j < matrix.size; ++j) {
    double* column = matrix.lower.data() + static_cast<std::ptrdiff_t>(j) * stride;
    const double pivot = column[0];
    if (!std::isfinite(pivot) || pivot == 0) {
      inertia.sound = false;
      return inertia;
    }
    (pivot > 0 ? inertia.positive : inertia.negative)++;
    int reach = std::min(matrix.bandwidth, matrix.size - 1 - j);
    while (reach > 0 && column[reach] == 0) --reach;
    for (int p = 1; p <= reach; ++p) {
      const double share = column[p] / pivot;
      if (share == 0) continue;
      double* target = matrix.lower.data() + static_cast<std::ptrdiff_t>(j + p) * stride - p;
      for (int q = p; q <= reach; ++q) target[q] -= share * column[q];
    }
    for (int p = 1; p <= reach; ++p) column[p] /= pivot;
  }
  return inertia;
}

void solve(const BandedMatrix& factored, std::vector<double>& x) {
  const int stride = factored.bandwidth + 1, size = factored.size;
  for (int j = 0; j < size; ++j) {
    const double* column = factored.lower.data() + static_cast<std::ptrdiff_t>(j) * stride;
    double* below = x.data() + j;
    const int reach = std::min(factored.bandwidth, size - 1 - j);
    for (int p = 1; p <= reach; ++p) below[p] -= column[p] * below[0];
  }
  for (int j = size - 1; j >= 0; --j) {
    const double* column = factored.lower.data() + static_cast<std::ptrdiff_t>(j) * stride;
    const double* below = x.data() + j;
    const int reach = std::min(factored.bandwidth, size - 1 - j);
    double value = x[static_cast<std::size_t>(j)] / column[0];
    for (int p = 1; p <= reach; ++p) value -= column[p] * below[p];
    x[static_cast<std::size_t>(j)] = value;
  }
}

}  // namespace wunderlich::math
