#include "wunderlich/math/banded.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

void GeneralBanded::reset(int new_size, int new_bandwidth) {
  size = new_size;
  bandwidth = new_bandwidth;
  rows.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(3 * bandwidth + 1), 0.0);
  pivot.assign(static_cast<std::size_t>(size), 0);
}

bool factor(GeneralBanded& matrix) {
  const int last = matrix.size - 1;
  for (int k = 0; k <= last; ++k) {
    const int low = std::min(last, k + matrix.bandwidth), right = std::min(last, k + 2 * matrix.bandwidth);
    int p = k;
    for (int i = k + 1; i <= low; ++i) {
      if (std::abs(matrix.at(i, k)) > std::abs(matrix.at(p, k))) p = i;
    }
    matrix.pivot[static_cast<std::size_t>(k)] = p;
    for (int j = k; p != k && j <= right; ++j) std::swap(matrix.at(k, j), matrix.at(p, j));
    const double divisor = matrix.at(k, k);
    if (!std::isfinite(divisor) || divisor == 0) return false;
    for (int i = k + 1; i <= low; ++i) {
      const double share = matrix.at(i, k) / divisor;
      matrix.at(i, k) = share;
      if (share == 0) continue;
      for (int j = k + 1; j <= right; ++j) matrix.at(i, j) -= share * matrix.at(k, j);
    }
  }
  return true;
}

void solve(const GeneralBanded& factored, std::vector<double>& x) {
  const int last = factored.size - 1;
  const auto entry = [&](int i) -> double& { return x[static_cast<std::size_t>(i)]; };
  for (int k = 0; k <= last; ++k) {
    std::swap(entry(k), entry(factored.pivot[static_cast<std::size_t>(k)]));
    for (int i = k + 1; i <= std::min(last, k + factored.bandwidth); ++i) entry(i) -= factored.at(i, k) * entry(k);
  }
  for (int k = last; k >= 0; --k) {
    double sum = entry(k);
    for (int j = k + 1; j <= std::min(last, k + 2 * factored.bandwidth); ++j) sum -= factored.at(k, j) * entry(j);
    entry(k) = sum / factored.at(k, k);
  }
}

}  // namespace wunderlich::math
