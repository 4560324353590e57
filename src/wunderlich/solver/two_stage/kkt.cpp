#include "wunderlich/solver/two_stage/kkt.hpp"

#include "wunderlich/energy/torsional_inertia.hpp"

namespace wunderlich::solver::two_stage {

using energy::EndsMatrix;
using geometry::Hinge;
using geometry::Ribbon;

namespace {

constexpr int kRows = 6;  // a block: eta, theta (3), multipliers (2)
constexpr int kMultiplier = 4;

using Jet2 = Eigen::Matrix<double, 2, 6>;

/// One end of a link: rows of what it depends on, -1 where held or absent, and d(kappa, tau)/d(theta before, after).
struct LinkEnd {
  std::array<int, 2> theta{-1, -1};
  int eta = -1;
  double eta_sign = 1;
  Jet2 slope = Jet2::Zero();
};

int theta_row(const Ribbon& ribbon, const Workspace& work, int segment) {
  if (segment < 0 || work.holding.frame_held[static_cast<std::size_t>(segment)]) return -1;
  return block_row(ribbon, segment) + 1;
}

int eta_row(const Ribbon& ribbon, const Workspace& work, int node) {
  return work.holding.eta_held[static_cast<std::size_t>(node)] ? -1 : block_row(ribbon, node);
}

LinkEnd link_end(const Ribbon& ribbon, const Workspace& work, std::size_t node) {
  const NodeView& view = work.views[node];
  LinkEnd end;
  end.eta = eta_row(ribbon, work, view.eta);
  end.eta_sign = view.eta_sign;
  if (view.hinge < 0) return end;
  const auto h = static_cast<std::size_t>(view.hinge);
  end.theta = {theta_row(ribbon, work, work.hinges[h].before), theta_row(ribbon, work, work.hinges[h].after)};
  const geometry::HingeJet& jet = work.jet[h];
  end.slope << view.sign * jet.before.row(1), view.sign * jet.after.row(1), jet.before.row(2), jet.after.row(2);
  return end;
}

/// Adds to the Hessian a^T curvature b of the angles at two ends; all of it where the ends are the same, else one
/// triangle, whose mirror image is implied. Unknowns may coincide: a segment between the ends is seen by both.
void scatter_angles(const LinkEnd& a, const LinkEnd& b, const Mat2& curvature, bool same, math::BandedMatrix& out) {
  const Eigen::Matrix<double, 6, 6> block = a.slope.transpose().lazyProduct((curvature * b.slope).eval());
  for (int i = 0; i < 6; ++i) {
    const int row = a.theta[static_cast<std::size_t>(i / 3)];
    if (row < 0) continue;
    for (int j = 0; j < (same ? i + 1 : 6); ++j) {
      const int column = b.theta[static_cast<std::size_t>(j / 3)];
      if (column < 0) continue;
      const bool diagonal = !same && row + i % 3 == column + j % 3;
      out.at(row + i % 3, column + j % 3) += diagonal ? 2 * block(i, j) : block(i, j);
    }
  }
}

/// The same between the angles at one end and eta of one.
void scatter_mixed(const LinkEnd& angles, const LinkEnd& eta, const Vec2& curvature, math::BandedMatrix& out) {
  if (eta.eta < 0) return;
  const Eigen::Matrix<double, 6, 1> column = eta.eta_sign * (angles.slope.transpose() * curvature);
  for (int i = 0; i < 6; ++i) {
    const int row = angles.theta[static_cast<std::size_t>(i / 3)];
    if (row >= 0) out.at(row + i % 3, eta.eta) += column[i];
  }
}

void scatter_link(const LinkEnd& a, const LinkEnd& b, const EndsMatrix& hessian, math::BandedMatrix& out) {
  scatter_angles(a, a, hessian.block<2, 2>(0, 0), true, out);
  scatter_angles(b, b, hessian.block<2, 2>(3, 3), true, out);
  scatter_angles(a, b, hessian.block<2, 2>(0, 3), false, out);
  scatter_mixed(a, a, hessian.block<2, 1>(0, 2), out);
  scatter_mixed(a, b, hessian.block<2, 1>(0, 5), out);
  scatter_mixed(b, a, hessian.block<2, 1>(3, 2), out);
  scatter_mixed(b, b, hessian.block<2, 1>(3, 5), out);
  if (a.eta >= 0) out.at(a.eta, a.eta) += hessian(2, 2);
  if (b.eta >= 0) out.at(b.eta, b.eta) += hessian(5, 5);
  if (a.eta >= 0 && b.eta >= 0) out.at(b.eta, a.eta) += a.eta_sign * b.eta_sign * hessian(2, 5);
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
  const energy::LinkTerms& terms = work.links[s];
  EndsMatrix hessian = terms.hessian;
  if (options.opt.barrier > 0) {
    const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double scale = options.opt.barrier * ribbon.bending_stiffness * ribbon.rest_length[s] / ribbon.width;
    const double second =
        scale * slope * slope * energy::ruling_barrier(slope * (shape.eta[s + 1] - shape.eta[s])).second;
    hessian(2, 2) += second;
    hessian(5, 5) += second;
    hessian(2, 5) -= second;
    hessian(5, 2) -= second;
  }
  scatter_link(link_end(ribbon, work, s), link_end(ribbon, work, s + 1), hessian, work.system);
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
void add_diagonal(const Ribbon& ribbon, const OptOptions& options, double shift, Workspace& work) {
  const double stiffness = ribbon.bending_stiffness, width = ribbon.width;
  for (int b = 0; b < block_count(ribbon); ++b) {
    const auto i = static_cast<std::size_t>(b);
    const double length = ribbon.rest_length[i < ribbon.rest_length.size() ? i : i - 1];
    const int row = block_row(ribbon, b);
    const bool no_frame = i >= work.holding.frame_held.size() || work.holding.frame_held[i];
    const double proximal = proximal_stiffness(ribbon, options, i);
    work.system.at(row, row) += work.holding.eta_held[i] ? 1.0 : proximal + shift * stiffness * length / width;
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
  add_diagonal(ribbon, options.opt, shift, work);
}

bool factor_kkt(const Ribbon& ribbon, Workspace& work) {
  work.factored = work.system;
  const math::Inertia inertia = math::factor(work.factored);
  return inertia.sound && inertia.negative == 2 * block_count(ribbon);
}

namespace {

/// Solves for right-hand sides by block, four of the unknowns (none: 0) and two of the constraints.
void solve_blocks(const Ribbon& ribbon, const std::vector<double>* gradient, Workspace& work,
                  std::vector<double>& step) {
  const int blocks = block_count(ribbon);
  work.kkt_rhs.assign(static_cast<std::size_t>(kRows * blocks), 0.0);
  for (int b = 0; b < blocks; ++b) {
    const auto row = static_cast<std::size_t>(block_row(ribbon, b)), i = static_cast<std::size_t>(b);
    for (std::size_t k = 0; gradient != nullptr && k < 4; ++k) work.kkt_rhs[row + k] = -(*gradient)[4 * i + k];
    for (std::size_t k = 0; k < 2; ++k) work.kkt_rhs[row + kMultiplier + k] = -work.residual[2 * i + k];
  }
  math::solve(work.factored, work.kkt_rhs);
  step.resize(static_cast<std::size_t>(4 * blocks));
  for (int b = 0; b < blocks; ++b) {
    const auto row = static_cast<std::size_t>(block_row(ribbon, b)), i = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 4; ++k) step[4 * i + k] = work.kkt_rhs[row + k];
  }
}

}  // namespace

void solve_kkt(const Ribbon& ribbon, Workspace& work, std::vector<double>& multipliers) {
  solve_blocks(ribbon, &work.gradient, work, work.step);
  multipliers.resize(static_cast<std::size_t>(2 * block_count(ribbon)));
  for (int b = 0; b < block_count(ribbon); ++b) {
    const auto row = static_cast<std::size_t>(block_row(ribbon, b)), i = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 2; ++k) multipliers[2 * i + k] = work.kkt_rhs[row + kMultiplier + k];
  }
}

void solve_correction(const Ribbon& ribbon, Workspace& work) { solve_blocks(ribbon, nullptr, work, work.correction); }

}  // namespace wunderlich::solver::two_stage
