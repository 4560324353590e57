/// Banded systems, linear in size: symmetric ones by LDL^T without pivoting, for matrices whose pivots have known
/// signs; others by LU with partial pivoting.
#pragma once

#include <vector>

namespace wunderlich::math {

/// The lower band, column by column: entry (i, j), j <= i <= j + bandwidth, stands at j (bandwidth + 1) + i - j.
struct BandedMatrix {
  int size = 0;
  int bandwidth = 0;
  std::vector<double> lower;

  /// Sets the shape and makes all entries zero; allocates only to grow.
  void reset(int new_size, int new_bandwidth);
  /// The entry (i, j) or (j, i), whichever is below the diagonal; must lie within the band.
  double& at(int i, int j) {
    const int low = i < j ? i : j, high = i < j ? j : i;
    return lower[static_cast<std::size_t>(low * (bandwidth + 1) + high - low)];
  }
};

/// Signs of the pivots, and whether all are finite and not zero.
struct Inertia {
  int positive = 0, negative = 0;
  bool sound = true;
};

/// Replaces the matrix by its factors L (unit lower, below the diagonal) and D (on it).
Inertia factor(BandedMatrix& matrix);

/// Solves with a factored matrix in place; `x` has `size` entries.
void solve(const BandedMatrix& factored, std::vector<double>& x);

/// A square matrix with entries (i, j), |i - j| <= bandwidth. Row by row, with room for what exchanging rows adds:
/// entry (i, j), i - bandwidth <= j <= i + 2 bandwidth, stands at i (3 bandwidth + 1) + j - i + bandwidth.
struct GeneralBanded {
  int size = 0;
  int bandwidth = 0;
  std::vector<double> rows;
  std::vector<int> pivot;  ///< of a factored one: the row that was exchanged with each

  /// Sets the shape and makes all entries zero; allocates only to grow.
  void reset(int new_size, int new_bandwidth);
  double& at(int i, int j) { return rows[place(i, j)]; }
  double at(int i, int j) const { return rows[place(i, j)]; }
  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(i * (3 * bandwidth + 1) + j - i + bandwidth);
  }
};

/// Replaces the matrix by its factors; false if it is singular to rounding, or not finite.
bool factor(GeneralBanded& matrix);

/// Solves with a factored matrix in place; `x` has `size` entries.
void solve(const GeneralBanded& factored, std::vector<double>& x);

/// Place of one of `count` items of a ring in the order 0, count - 1, 1, count - 2, ...: items d apart on the ring
/// stand at most 2 d apart, so that cyclic bands become plain ones of twice the width.
inline int folded_place(int item, int count) { return 2 * item < count ? 2 * item : 2 * (count - 1 - item) + 1; }

}  // namespace wunderlich::math
