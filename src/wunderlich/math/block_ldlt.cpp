#include "wunderlich/math/block_ldlt.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wunderlich::math {

namespace {

using Eigen::Index;
using Eigen::SparseMatrix;
using Panel = Eigen::Map<Eigen::MatrixXd>;

constexpr int kWidest = 48;          // columns of a block: what stays in the cache
constexpr double kMostZeros = 0.15;  // of a block's values, to have fewer and wider blocks

std::size_t at(int i) { return static_cast<std::size_t>(i); }

int block_count(const BlockFactor& factor) { return static_cast<int>(factor.below.size()); }
int width_of(const BlockFactor& factor, int block) { return factor.first[at(block + 1)] - factor.first[at(block)]; }

Panel panel_of(BlockFactor& factor, int block) {
  const int width = width_of(factor, block);
  const auto height = width + static_cast<Index>(factor.below[at(block)].size());
  return {factor.values.data() + factor.start[at(block)], height, width};
}

/// Finds the rows of one column after the other, and joins it to the block before it where few zeros come in.
class Analysis {
 public:
  Analysis(const SparseMatrix<double>& lower, BlockFactor& factor)
      : lower_(lower), factor_(factor), children_(at(size())), mark_(at(size()), -1) {}

  void run() {
    factor_.first.clear(), factor_.below.clear();
    factor_.block_of.resize(at(size()));
    for (int j = 0; j < size(); ++j) {
      find_rows(j);
      if (!joins(j)) {
        close(j);
        factor_.first.push_back(j);
        factor_.below.emplace_back();
        zeros_ = 0;
      }
      factor_.block_of[at(j)] = block_count(factor_) - 1;
      std::swap(factor_.below.back(), rows_);
    }
    close(size());
    factor_.first.push_back(size());
    factor_.start.assign(1, 0);
    for (int b = 0; b < block_count(factor_); ++b) {
      const std::size_t width = at(width_of(factor_, b));
      factor_.start.push_back(factor_.start.back() + width * (width + factor_.below[at(b)].size()));
      std::sort(factor_.below[at(b)].begin(), factor_.below[at(b)].end());
    }
  }

 private:
  int size() const { return static_cast<int>(lower_.cols()); }

  /// The matrix' own and those that blocks before bring in whose first row below is this one.
  void find_rows(int j) {
    rows_.clear();
    const auto take = [&](int row) {
      if (row <= j || mark_[at(row)] == j) return;
      mark_[at(row)] = j;
      rows_.push_back(row);
    };
    for (SparseMatrix<double>::InnerIterator it(lower_, j); it; ++it) take(static_cast<int>(it.row()));
    for (const int block : children_[at(j)]) {
      for (const int row : factor_.below[at(block)]) take(row);
    }
    if (follows(j)) {
      for (const int row : factor_.below.back()) take(row);
    }
  }

  /// Is this the first row below the open block?
  bool follows(int j) const {
    if (factor_.below.empty() || factor_.below.back().empty()) return false;
    const std::vector<int>& below = factor_.below.back();
    return *std::min_element(below.begin(), below.end()) == j;
  }

  bool joins(int j) {
    if (!follows(j)) return false;
    const double width = j - factor_.first.back();
    if (width == kWidest) return false;
    const double zeros = zeros_ + width * static_cast<double>(rows_.size() + 1 - factor_.below.back().size());
    if (zeros > kMostZeros * (width + 1) * (0.5 * width + static_cast<double>(rows_.size()))) return false;
    zeros_ = zeros;
    return true;
  }

  /// The open block ends before column j, and waits for its first row.
  void close(int j) {
    if (j == 0 || factor_.below.back().empty()) return;
    const std::vector<int>& below = factor_.below.back();
    children_[at(*std::min_element(below.begin(), below.end()))].push_back(block_count(factor_) - 1);
  }

  const SparseMatrix<double>& lower_;
  BlockFactor& factor_;
  std::vector<std::vector<int>> children_;  ///< closed blocks by their first row below
  std::vector<int> mark_, rows_;
  double zeros_ = 0;  ///< in the open block
};

void copy_values(const SparseMatrix<double>& lower, BlockFactor& factor) {
  std::fill(factor.values.begin(), factor.values.end(), 0.0);
  for (int b = 0; b < block_count(factor); ++b) {
    const int first = factor.first[at(b)], width = width_of(factor, b);
    const std::vector<int>& below = factor.below[at(b)];
    for (std::size_t k = 0; k < below.size(); ++k) factor.place[at(below[k])] = width + static_cast<int>(k);
    Panel panel = panel_of(factor, b);
    for (int c = 0; c < width; ++c) {
      for (SparseMatrix<double>::InnerIterator it(lower, first + c); it; ++it) {
        const auto row = static_cast<int>(it.row());
        panel(row < first + width ? row - first : factor.place[at(row)], c) = it.value();
      }
    }
  }
}

/// Factors the triangle on top, and divides what is below by it.
bool factorise_panel(Panel panel, Eigen::Ref<Eigen::VectorXd> pivots) {
  const Index width = panel.cols(), below = panel.rows() - width;
  for (Index c = 0; c < width; ++c) {
    const double pivot = pivots[c] = panel(c, c);
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    const Index rest = width - c - 1;
    panel.col(c).segment(c + 1, rest) /= pivot;
    for (Index k = c + 1; k < width; ++k) {
      panel.col(k).segment(k, width - k) -= pivot * panel(k, c) * panel.col(c).segment(k, width - k);
    }
  }
  if (below == 0) return true;
  const auto triangle = panel.topRows(width).transpose().triangularView<Eigen::UnitUpper>();
  auto rows = panel.bottomRows(below);
  triangle.solveInPlace<Eigen::OnTheRight>(rows);
  rows.array().rowwise() /= pivots.transpose().array();
  return true;
}

/// Takes from the columns of later blocks what this block does to them.
void spread(BlockFactor& factor, int block) {
  const std::vector<int>& below = factor.below[at(block)];
  const auto count = static_cast<Index>(below.size());
  const Index width = width_of(factor, block);
  const auto rows = panel_of(factor, block).bottomRows(count);
  factor.scaled.noalias() = rows * factor.pivots.segment(factor.first[at(block)], width).asDiagonal();
  for (Index from = 0, to = 0; from < count; from = to) {
    const int target = factor.block_of[at(below[static_cast<std::size_t>(from)])];
    const int first = factor.first[at(target)], last = factor.first[at(target + 1)];
    while (to < count && below[static_cast<std::size_t>(to)] < last) ++to;
    factor.update.noalias() = rows.bottomRows(count - from) * factor.scaled.middleRows(from, to - from).transpose();
    // Both lists ascend: each row is at or after the place of the one before.
    const std::vector<int>& others = factor.below[at(target)];
    auto other = others.begin();
    for (Index i = from; i < count; ++i) {
      const int row = below[static_cast<std::size_t>(i)];
      int place = row - first;
      if (row >= last) {
        while (*other != row) ++other;
        place = last - first + static_cast<int>(other - others.begin());
      }
      factor.place[static_cast<std::size_t>(i - from)] = place;
    }
    Panel panel = panel_of(factor, target);
    for (Index c = from; c < to; ++c) {
      double* const column = &panel(0, below[static_cast<std::size_t>(c)] - first);
      const double* const taken = &factor.update(0, c - from);
      for (Index i = c; i < count; ++i) column[factor.place[static_cast<std::size_t>(i - from)]] -= taken[i - from];
    }
  }
}

}  // namespace

void analyse(const SparseMatrix<double>& lower, BlockFactor& factor) {
  Analysis(lower, factor).run();
  factor.values.resize(factor.start.back());
  factor.place.resize(at(static_cast<int>(lower.cols())));
  factor.pivots.resize(lower.cols());
}

bool factorise(const SparseMatrix<double>& lower, BlockFactor& factor) {
  copy_values(lower, factor);
  for (int b = 0; b < block_count(factor); ++b) {
    if (!factorise_panel(panel_of(factor, b), factor.pivots.segment(factor.first[at(b)], width_of(factor, b)))) {
      return false;
    }
    spread(factor, b);
  }
  return true;
}

void solve(BlockFactor& factor, Eigen::VectorXd& x) {
  for (int b = 0; b < block_count(factor); ++b) {
    const Panel panel = panel_of(factor, b);
    const std::vector<int>& below = factor.below[at(b)];
    auto own = x.segment(factor.first[at(b)], panel.cols());
    panel.topRows(panel.cols()).triangularView<Eigen::UnitLower>().solveInPlace(own);
    factor.part.noalias() = panel.bottomRows(panel.rows() - panel.cols()) * own;
    for (std::size_t k = 0; k < below.size(); ++k) x[below[k]] -= factor.part[static_cast<Index>(k)];
  }
  x.array() /= factor.pivots.array();
  for (int b = block_count(factor) - 1; b >= 0; --b) {
    const Panel panel = panel_of(factor, b);
    const std::vector<int>& below = factor.below[at(b)];
    factor.part.resize(static_cast<Index>(below.size()));
    for (std::size_t k = 0; k < below.size(); ++k) factor.part[static_cast<Index>(k)] = x[below[k]];
    auto own = x.segment(factor.first[at(b)], panel.cols());
    own.noalias() -= panel.bottomRows(panel.rows() - panel.cols()).transpose() * factor.part;
    panel.topRows(panel.cols()).transpose().triangularView<Eigen::UnitUpper>().solveInPlace(own);
  }
}

}  // namespace wunderlich::math
