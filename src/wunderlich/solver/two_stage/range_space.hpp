/// The linearised constraints of Eq. 22 by unknown, and the matrix J M^-1 J^T of the range-space method.
#pragma once

#include <array>
#include <vector>

#include "wunderlich/geometry/state.hpp"
#include "wunderlich/math/banded.hpp"

namespace wunderlich::solver::two_stage {

struct Workspace;

/// Rows a block: gamma h, (kappa eta - tau) h, and |x| - limit of the segment that starts at its node.
inline constexpr int kBlockRows = 3;
/// |x| that the bound allows: short of 1, where the log energy is infinite.
inline constexpr double kRulingLimit = 1 - 1e-4;

/// An entry of J: its row, and the derivative by the unknown.
struct Entry {
  int row;
  double slope;
};

/// The rows that see one unknown: those of at most two hinges or segments.
struct ColumnEntries {
  std::array<Entry, 4> entry;
  int count = 0;
};

struct RangeSpace {
  std::vector<ColumnEntries> columns;  ///< (4 a block) J by unknown; none where held
  std::vector<double> residual;        ///< (3 a block)
  std::vector<double> multipliers;     ///< (3 a block)
  std::vector<char> active;            ///< (3 a block) bounds that act as equations
  math::BandedMatrix normal;           ///< J M^-1 J^T of all rows
};

/// At the refreshed jets and residuals of a state, into work.range.
void assemble_range(const geometry::Ribbon& ribbon, const geometry::State& shape, Workspace& work);

/// out = -M^-1 J^T multipliers.
void push_back(const std::vector<double>& multipliers, const RangeSpace& space, std::vector<double>& out);

/// Factors the matrix of the equations and the active bounds; other rows stand alone.
bool factor_active(const std::vector<char>& active, const RangeSpace& space, math::BandedMatrix& factored);

}  // namespace wunderlich::solver::two_stage
