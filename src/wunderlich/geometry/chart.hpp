/// Increments of a state: the local coordinates in which energies and constraints give their derivatives.
///
/// Node i has r_i (3) and eta_i (1); segment s has theta^s (3), a rotation vector in the segment's own axes:
/// r_i += dr_i, eta_i += deta_i, q^s <- q^s exp(theta^s). They are interleaved along the strip, seven a segment,
///   r_0 eta_0 theta^0 | r_1 eta_1 theta^1 | ... | r_n eta_n,
/// so that matrices are banded. Both ends of a loop are in the chart; that they are one is a constraint.
///
/// Derivatives at a state are those of x -> f(state moved by x) at x = 0. Sparse matrices are lists of triplets,
/// in which equal places add up; symmetric ones list both triangles.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::geometry {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Where r, eta of a node and theta of a segment begin in an increment, and how many entries it has.
inline int r_index(int node) { return 7 * node; }
inline int eta_index(int node) { return 7 * node + 3; }
inline int theta_index(int segment) { return 7 * segment + 4; }
inline int chart_size(const Ribbon& ribbon) { return 7 * ribbon.segments + 4; }

/// Moves a state by an increment of size chart_size. Frames of free ends follow their segments.
void move(const Ribbon& ribbon, const Eigen::Ref<const Eigen::VectorXd>& increment, State& state);

/// Adds a dense block at (row, column).
template <typename Block>
void add_block(int row, int column, const Eigen::MatrixBase<Block>& block, Triplets& out) {
  for (int i = 0; i < block.rows(); ++i) {
    for (int j = 0; j < block.cols(); ++j) out.emplace_back(row + i, column + j, block(i, j));
  }
}

/// A hinge with all it depends on: which frames it joins, how they move with the chart.
struct Hinge {
  int node = 0;
  double length = 0;            ///< [m]
  int before = -1, after = -1;  ///< segments joined; -1 where the end frame is prescribed
  double flip = 1;              ///< -1 if `after` is seen across a seam that reverses the surface
};

/// The hinges of a ribbon in order of their nodes; free ends have none.
std::vector<Hinge> hinges(const Ribbon& ribbon);

/// The strain (gamma, kappa, tau) of a hinge and its derivatives in theta^before and theta^after.
struct HingeJet {
  Vec3 strain;         ///< [1/m]
  Mat3 before, after;  ///< d strain / d theta [1/m]
};
HingeJet hinge_jet(const Ribbon& ribbon, const State& state, const Hinge& hinge, StrainMeasure measure);

/// Hessian of weight . strain in (theta^before, theta^after).
struct HingeHessian {
  Mat3 before_before, before_after, after_after;
};
HingeHessian hinge_hessian(const Ribbon& ribbon, const State& state, const Hinge& hinge, StrainMeasure measure,
                           const Vec3& weight);

}  // namespace wunderlich::geometry
