#include "wunderlich/solver/two_stage/kkt.hpp"

#include "wunderlich/energy/torsional_inertia.hpp"

namespace wunderlich::solver::two_stage {

using energy::Ends;
using energy::EndsMatrix;
using geometry::Hinge;
using geometry::Ribbon;

namespace {

constexpr int kRows = 6;  // a block: eta, theta (3), multipliers (2)
constexpr int kMultiplier = 4;
constexpr int kLocal = 14;  // theta of the two segments at either end's hinge, then eta of both ends

/// Rows of the system that a link's ends depend on, -1 where held or absent, and the ends' derivatives in them.
struct Local {
  std::array<int, kLocal> row;
  Eigen::Matrix<double, 6, kLocal> slope = Eigen::Matrix<double, 6, kLocal>::Zero();
};

int theta_row(const Ribbon& ribbon, const Workspace& work, int segment) {
  if (segment < 0 || work.holding.frame_held[static_cast<std::size_t>(segment)]) return -1;
  return block_row(ribbon, segment) + 1;
}

int eta_row(const Ribbon& ribbon, const Workspace& work, int node) {
  return work.holding.eta_held[static_cast<std::size_t>(node)] ? -1 : block_row(ribbon, node);
}

Local local_at(const Ribbon& ribbon, const Workspace& work, std::size_t segment) {
  Local local;
  local.row.fill(-1);
  for (int side : {0, 1}) {
    const NodeView& view = work.views[segment + static_cast<std::size_t>(side)];
    local.row[static_cast<std::size_t>(12 + side)] = eta_row(ribbon, work, view.eta);
    local.slope(3 * side + 2, 12 + side) = view.eta_sign;
    if (view.hinge < 0) continue;
    const auto h = static_cast<std::size_t>(view.hinge);
    const int rows[2] = {theta_row(ribbon, work, work.hinges[h].before), theta_row(ribbon, work, work.hinges[h].after)};
    for (int part : {0, 1}) {
      const int at = 6 * side + 3 * part;
      const Mat3& jet = part == 0 ? work.jet[h].before : work.jet[h].after;
      local.slope.block<1, 3>(3 * side, at) = view.sign * jet.row(1);
      local.slope.block<1, 3>(3 * side + 1, at) = jet.row(2);
      for (int k = 0; k < 3; ++k) {
        local.row[static_cast<std::size_t>(at + k)] = rows[part] < 0 ? -1 : rows[part] + k;
      }
    }
  }
  return local;
}

/// Adds a symmetric local matrix. Local unknowns may coincide, their entries add up.
void scatter(const Local& local, const Eigen::Matrix<double, kLocal, kLocal>& matrix, math::BandedMatrix& out) {
  for (int i = 0; i < kLocal; ++i) {
    const int row = local.row[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    for (int j = 0; j < kLocal; ++j) {
      const int column = local.row[static_cast<std::size_t>(j)];
      if (column >= 0 && column <= row) out.at(row, column) += matrix(i, j);
    }
  }
}

void scatter_block(int row, int column, const Mat3& block, math::BandedMatrix& out) {
  if (row < 0 || column < 0) return;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (row != column || j <= i) out.at(row + i, column + j) += block(i, j);
    }
  }
}

/// Energy of one link and its barrier: curvature in the strains, and slopes by hinge for the rest.
void add_link(const Ribbon& ribbon, const Options& options, const geometry::State& shape, std::size_t s,
              Workspace& work) {
  const Ends ends = link_ends(shape, work, s);
  energy::LinkTerms terms = energy::link_terms(ribbon, options.model, s, ends);
  if (options.opt.barrier > 0) {
    const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double scale = options.opt.barrier * ribbon.bending_stiffness * ribbon.rest_length[s] / ribbon.width;
    const double second =
        scale * slope * slope * energy::ruling_barrier(slope * (ends[energy::kEtaB] - ends[energy::kEtaA])).second;
    terms.hessian(2, 2) += second;
    terms.hessian(5, 5) += second;
    terms.hessian(2, 5) -= second;
    terms.hessian(5, 2) -= second;
  }
  const Local local = local_at(ribbon, work, s);
  const Eigen::Matrix<double, 6, kLocal> half = terms.hessian * local.slope;
  scatter(local, local.slope.transpose().lazyProduct(half), work.system);
  for (int side : {0, 1}) {
    const NodeView& view = work.views[s + static_cast<std::size_t>(side)];
    if (view.hinge < 0) continue;
    Vec3& slope = work.hinge_slope[static_cast<std::size_t>(view.hinge)];
    slope += Vec3(0, view.sign * terms.gradient[3 * side], terms.gradient[3 * side + 1]);
  }
}

/// Rows of gamma h and (kappa eta - tau) h.   @eq Shen2015:22
void add_constraints(const Ribbon& ribbon, const geometry::State& shape, std::size_t h, Workspace& work) {
  const Hinge& hinge = work.hinges[h];
  const double eta = shape.eta[static_cast<std::size_t>(hinge.node)];
  const int row = block_row(ribbon, hinge_block(ribbon, hinge)) + kMultiplier;
  for (int part : {0, 1}) {
    const int column = theta_row(ribbon, work, part == 0 ? hinge.before : hinge.after);
    if (column < 0) continue;
    const Mat3& jet = part == 0 ? work.jet[h].before : work.jet[h].after;
    const Eigen::RowVector3d binormal = hinge.length * jet.row(0);
    const Eigen::RowVector3d match = hinge.length * (eta * jet.row(1) - jet.row(2));
    for (int k = 0; k < 3; ++k) {
      work.system.at(row, column + k) += binormal[k];
      work.system.at(row + 1, column + k) += match[k];
    }
  }
  const NodeView& view = work.views[static_cast<std::size_t>(hinge.node)];
  const int column = eta_row(ribbon, work, view.eta);
  if (column >= 0) work.system.at(row + 1, column) += view.eta_sign * hinge.length * work.strain[h][1];
}

/// Second derivatives of the strains in the angles, and of kappa eta in both, weighted with the multipliers.
void add_second_order(const Ribbon& ribbon, const Options& options, const geometry::State& shape,
                      const std::vector<double>& multipliers, std::size_t h, Workspace& work) {
  const Hinge& hinge = work.hinges[h];
  const auto at = static_cast<std::size_t>(2 * hinge_block(ribbon, hinge));
  const double eta = shape.eta[static_cast<std::size_t>(hinge.node)];
  const double binormal = hinge.length * multipliers[at], match = hinge.length * multipliers[at + 1];
  const Vec3 weight = work.hinge_slope[h] + Vec3(binormal, match * eta, -match);
  const geometry::HingeHessian second = geometry::hinge_hessian(ribbon, shape, hinge, options.model.strain, weight);
  const int before = theta_row(ribbon, work, hinge.before), after = theta_row(ribbon, work, hinge.after);
  scatter_block(before, before, second.before_before, work.system);
  scatter_block(after, after, second.after_after, work.system);
  scatter_block(before, after, second.before_after, work.system);
  const NodeView& view = work.views[static_cast<std::size_t>(hinge.node)];
  const int row = eta_row(ribbon, work, view.eta);
  if (row < 0) return;
  for (int k = 0; k < 3; ++k) {
    if (before >= 0) work.system.at(row, before + k) += view.eta_sign * match * work.jet[h].before(1, k);
    if (after >= 0) work.system.at(row, after + k) += view.eta_sign * match * work.jet[h].after(1, k);
  }
}

/// Rows without an unknown or a hinge stand alone; a trace on the multipliers keeps a hinge between two held frames
/// solvable.
void add_diagonal(const Ribbon& ribbon, double shift, Workspace& work) {
  const double stiffness = ribbon.bending_stiffness, width = ribbon.width;
  for (int b = 0; b < block_count(ribbon); ++b) {
    const auto i = static_cast<std::size_t>(b);
    const double length = ribbon.rest_length[i < ribbon.rest_length.size() ? i : i - 1];
    const int row = block_row(ribbon, b);
    const bool no_frame = i >= work.holding.frame_held.size() || work.holding.frame_held[i];
    work.system.at(row, row) += work.holding.eta_held[i] ? 1.0 : shift * stiffness * length / width;
    for (int k = 1; k < 4; ++k) {
      work.system.at(row + k, row + k) += no_frame ? 1.0 : shift * stiffness * width / length;
    }
    const double trace = 1e-12 * length / (stiffness * width);
    const bool hinge = work.views[ribbon.is_loop() && b == 0 ? work.views.size() - 1 : i].hinge >= 0;
    for (int k = kMultiplier; k < kRows; ++k) work.system.at(row + k, row + k) -= hinge ? trace : 1.0;
  }
}

}  // namespace

int block_row(const Ribbon& ribbon, int block) {
  return kRows * (ribbon.is_loop() ? math::folded_place(block, ribbon.segments) : block);
}

void assemble_kkt(const Ribbon& ribbon, const Options& options, const geometry::State& shape,
                  const std::vector<double>& multipliers, Curvature curvature, double shift, Workspace& work) {
  // Links reach two blocks; in a folded loop, four places.
  work.system.reset(kRows * block_count(ribbon), ribbon.is_loop() ? 4 * kRows + 3 : 2 * kRows + 3);
  work.hinge_slope.assign(work.hinges.size(), Vec3::Zero());
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    add_link(ribbon, options, shape, s, work);
    const int row = theta_row(ribbon, work, static_cast<int>(s));
    scatter_block(row, row, frame_terms(ribbon, shape, work, s).hessian, work.system);
  }
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    add_constraints(ribbon, shape, h, work);
    if (curvature == Curvature::exact) add_second_order(ribbon, options, shape, multipliers, h, work);
  }
  add_diagonal(ribbon, shift, work);
}

bool factor_kkt(const Ribbon& ribbon, Workspace& work) {
  work.factored = work.system;
  const math::Inertia inertia = math::factor(work.factored);
  return inertia.sound && inertia.negative == 2 * block_count(ribbon);
}

void solve_kkt(const Ribbon& ribbon, Workspace& work, std::vector<double>& multipliers) {
  const int blocks = block_count(ribbon);
  work.kkt_rhs.assign(static_cast<std::size_t>(kRows * blocks), 0.0);
  const auto row = [&](int block) { return static_cast<std::size_t>(block_row(ribbon, block)); };
  for (int b = 0; b < blocks; ++b) {
    const auto i = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 4; ++k) work.kkt_rhs[row(b) + k] = -work.gradient[4 * i + k];
    for (std::size_t k = 0; k < 2; ++k) work.kkt_rhs[row(b) + kMultiplier + k] = -work.residual[2 * i + k];
  }
  math::solve(work.factored, work.kkt_rhs);
  work.step.resize(static_cast<std::size_t>(4 * blocks));
  multipliers.resize(static_cast<std::size_t>(2 * blocks));
  for (int b = 0; b < blocks; ++b) {
    const auto i = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 4; ++k) work.step[4 * i + k] = work.kkt_rhs[row(b) + k];
    for (std::size_t k = 0; k < 2; ++k) multipliers[2 * i + k] = work.kkt_rhs[row(b) + kMultiplier + k];
  }
}

}  // namespace wunderlich::solver::two_stage
