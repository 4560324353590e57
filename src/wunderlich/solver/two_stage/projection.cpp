#include "wunderlich/solver/two_stage/projection.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/solver/two_stage/gauss_seidel.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"
#include "wunderlich/solver/two_stage/range_space.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// The metric of one unknown: |dq|^2 is a quarter of |theta|^2.
double inverse_metric(std::size_t unknown) { return unknown % 4 == 0 ? 1 : 4; }

void add_entry(RangeSpace& space, int unknown, int row, double slope) {
  ColumnEntries& column = space.columns[static_cast<std::size_t>(unknown)];
  column.entry[static_cast<std::size_t>(column.count++)] = {row, slope};
}

int row_at(const Ribbon& ribbon, int block) {
  return kBlockRows * (ribbon.is_loop() ? math::folded_place(block, ribbon.segments) : block);
}

void add_hinge_rows(const Ribbon& ribbon, const geometry::State& shape, std::size_t h, Workspace& work) {
  const geometry::Hinge& hinge = work.hinges[h];
  RangeSpace& space = work.range;
  const int block = hinge_block(ribbon, hinge), row = row_at(ribbon, block);
  const double eta = shape.eta[static_cast<std::size_t>(hinge.node)];
  for (const int part : {0, 1}) {
    const int segment = part == 0 ? hinge.before : hinge.after;
    if (segment < 0 || work.holding.frame_held[static_cast<std::size_t>(segment)]) continue;
    const Mat3& jet = part == 0 ? work.jet[h].before : work.jet[h].after;
    for (int k = 0; k < 3; ++k) {
      add_entry(space, 4 * segment + 1 + k, row, hinge.length * jet(0, k));
      add_entry(space, 4 * segment + 1 + k, row + 1, hinge.length * (eta * jet(1, k) - jet(2, k)));
    }
  }
  const NodeView& view = work.views[static_cast<std::size_t>(hinge.node)];
  if (!work.holding.eta_held[static_cast<std::size_t>(view.eta)]) {
    add_entry(space, 4 * view.eta, row + 1, view.eta_sign * hinge.length * work.strain[h][1]);
  }
  for (int k = 0; k < 2; ++k) {
    space.residual[static_cast<std::size_t>(row + k)] = work.residual[static_cast<std::size_t>(2 * block + k)];
  }
}

/// |x| - limit of one segment; negative while it holds.
void add_bound_row(const Ribbon& ribbon, const geometry::State& shape, std::size_t s, Workspace& work) {
  RangeSpace& space = work.range;
  const int row = row_at(ribbon, static_cast<int>(s)) + 2;
  const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
  const double x = slope * (shape.eta[s + 1] - shape.eta[s]);
  const double sign = std::copysign(1.0, x);
  space.residual[static_cast<std::size_t>(row)] = std::abs(x) - kRulingLimit;
  for (const std::size_t side : {0u, 1u}) {
    const NodeView& view = work.views[s + side];
    if (work.holding.eta_held[static_cast<std::size_t>(view.eta)]) continue;
    add_entry(space, 4 * view.eta, row, (side == 0 ? -1 : 1) * sign * view.eta_sign * slope);
  }
}

}  // namespace

void assemble_range(const Ribbon& ribbon, const geometry::State& shape, Workspace& work) {
  RangeSpace& space = work.range;
  const int blocks = block_count(ribbon);
  space.columns.assign(static_cast<std::size_t>(4 * blocks), {});
  space.residual.assign(static_cast<std::size_t>(kBlockRows * blocks), 0.0);
  space.normal.reset(kBlockRows * blocks, (ribbon.is_loop() ? 2 : 1) * kBlockRows + kBlockRows - 1);
  for (std::size_t h = 0; h < work.hinges.size(); ++h) add_hinge_rows(ribbon, shape, h, work);
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) add_bound_row(ribbon, shape, s, work);
  for (std::size_t u = 0; u < space.columns.size(); ++u) {
    const ColumnEntries& column = space.columns[u];
    for (std::size_t i = 0; i < static_cast<std::size_t>(column.count); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        space.normal.at(column.entry[i].row, column.entry[j].row) +=
            inverse_metric(u) * column.entry[i].slope * column.entry[j].slope;
      }
    }
  }
}

void push_back(const std::vector<double>& multipliers, const RangeSpace& space, std::vector<double>& out) {
  out.assign(space.columns.size(), 0.0);
  for (std::size_t u = 0; u < space.columns.size(); ++u) {
    const ColumnEntries& column = space.columns[u];
    for (std::size_t i = 0; i < static_cast<std::size_t>(column.count); ++i) {
      out[u] -= inverse_metric(u) * column.entry[i].slope * multipliers[static_cast<std::size_t>(column.entry[i].row)];
    }
  }
}

bool factor_active(const std::vector<char>& active, const RangeSpace& space, math::BandedMatrix& factored) {
  factored = space.normal;
  const int size = factored.size, reach = factored.bandwidth;
  for (int row = 0; row < size; ++row) {
    double& diagonal = factored.at(row, row);
    if (row % kBlockRows < 2 && diagonal > 0) {
      diagonal *= 1 + 1e-12;  // rows that depend on each other stay solvable
      continue;
    }
    if (row % kBlockRows == 2 && active[static_cast<std::size_t>(row)]) continue;
    for (int other = std::max(0, row - reach); other <= std::min(size - 1, row + reach); ++other) {
      factored.at(row, other) = 0;
    }
    factored.at(row, row) = 1;
  }
  return math::factor(factored).sound;
}

namespace {

/// Multipliers of the active set's equations. A bound joins the set when violated and leaves when it pulls.
bool solve_direct(RangeSpace& space, Workspace& work) {
  for (std::size_t row = 2; row < space.residual.size(); row += kBlockRows) {
    const bool kept = space.active[row] && space.multipliers[row] >= 0 && space.residual[row] > -1e-9;
    space.active[row] = kept || space.residual[row] > 0;
  }
  if (!factor_active(space.active, space, work.factored)) return false;
  space.multipliers = space.residual;
  for (std::size_t row = 2; row < space.residual.size(); row += kBlockRows) {
    if (!space.active[row]) space.multipliers[row] = 0;
  }
  math::solve(work.factored, space.multipliers);
  return true;
}

}  // namespace

bool project(const Ribbon& ribbon, const Options& options, geometry::State& shape, Workspace& work,
             StepReport& report) {
  RangeSpace& space = work.range;
  space.active.assign(static_cast<std::size_t>(kBlockRows * block_count(ribbon)), 0);
  space.multipliers.assign(space.active.size(), 0.0);
  // Well below what is asked, so that what follows within the iteration cannot spoil it.
  const double tolerance = 0.1 * options.opt.constraint_tolerance;
  for (int iteration = 0;; ++iteration) {
    refresh_strains(ribbon, options.model, shape, true, work);
    const double violation = constraint_residual(ribbon, shape, work);
    if (violation <= tolerance && largest_ruling_ratio(ribbon, shape) < 1) return true;
    if (iteration == options.opt.max_projections || !std::isfinite(violation)) return false;
    assemble_range(ribbon, shape, work);
    if (options.opt.projection == Projection::direct) {
      if (!solve_direct(space, work)) return false;
    } else {
      const SweepReport swept = solve_gauss_seidel(space, 0.1 * tolerance, options.opt.max_sweeps);
      report.sweeps += swept.sweeps;
      report.capped += swept.capped;
    }
    ++report.projections;
    push_back(space.multipliers, space, work.step);
    work.q_start = shape.q;
    work.eta_start = shape.eta;
    move_unknowns(ribbon, work.step, std::min(1.0, largest_share(work.step)), work, shape);
  }
}

}  // namespace wunderlich::solver::two_stage
