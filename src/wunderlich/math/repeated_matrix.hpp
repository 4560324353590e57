/// Sparse matrices of one pattern, filled again and again. Internal to math/.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace wunderlich::math {

/// A symmetric sparse matrix that is filled again and again in the same order of entries.
class RepeatedMatrix {
 public:
  /// Starts anew: the entries that follow are noted, and make the pattern.
  void note(int size);
  /// Starts with all zeros; the entries that follow are those noted.
  void repeat();
  void add(int row, int column, double value);
  /// Ends the filling after `note`.
  void settle();
  const Eigen::SparseMatrix<double>& lower() const { return lower_; }

 private:
  bool noting_ = false;
  int size_ = 0;
  std::size_t next_ = 0;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<int> slot_;  ///< where each entry goes among the values
  Eigen::SparseMatrix<double> lower_;
};

}  // namespace wunderlich::math
