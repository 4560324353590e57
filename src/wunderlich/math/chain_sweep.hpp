/// Newton's step on a chain of links in O(n): one backward and one forward sweep.
///
/// A chain of N links hangs from a base. The joint before link i turns it by two coordinates u_i; link i spans
/// from node i to node i + 1. An objective that is a sum of node terms (position), link terms (frame, u_i,
/// u_{i+1}) and a terminal term has an 8 x 8 value function per node, in the pose increments (v, theta) of the
/// link (world axes, origin at its node) and u_i. The backward sweep eliminates u_N ... u_0 and the base, the
/// forward sweep reads off the step: a Riccati recursion, cousin of the articulated-body algorithm.
/// Equality constraints enter as further right-hand sides ("columns") and a small Schur complement.
///
/// Sources: @eq Featherstone2008:7.3 for the recursion on bodies, @eq Rawlings2017:8.8 for its reading as optimal
/// control; the second-order terms of joints and spans are derived in docs/theory.md.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/math/four.hpp"

namespace wunderlich::math {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec8 = Eigen::Matrix<double, 8, 1>;
using Mat8 = Eigen::Matrix<double, 8, 8>;

/// First and second derivatives of the objective around one node: the joint at node i, the node, link i.
/// Vectors of space have a fourth lane that is 0.
struct ChainLink {
  Four axis[2];           ///< d theta / d u of the joint, world; zero for a fixed coordinate
  Four axis_01, axis_11;  ///< second derivatives of the joint's rotation, world (the 00 one vanishes)
  Four span;              ///< node i to node i + 1, world; unused at the last node
  Four force;             ///< gradient of the node term in r_i
  double stiffness;       ///< Hessian of the node term in r_i is stiffness * identity
  Vec2 grad_a, grad_b;    ///< gradient of link i's energy in u_i, u_{i+1}
  Mat2 hess_aa, hess_ab, hess_bb;
  double chart = 0;  ///< c: the Hessian is taken where u_1 moves by du_1 - c du_0 du_1, not straight on
};

/// Row of a linearised constraint: a functional of the pose of one link (or the end frame), of its u, and of
/// the base pose and u_0 (for closures).
struct ChainRow {
  int node;  ///< link whose pose and u it sees; N: the end frame
  Vec3 v = Vec3::Zero(), theta = Vec3::Zero();
  Vec2 u = Vec2::Zero();
  Vec3 base_v = Vec3::Zero(), base_theta = Vec3::Zero();
  Vec2 first_u = Vec2::Zero();
  double residual = 0;    ///< value at the current iterate; the step makes it 0
  double penalty = 0;     ///< adds penalty/2 (pose part of the row)^2 to the objective
  double multiplier = 0;  ///< current value, for the geometric terms
};

/// A term in the pose of link `node` (N: the end frame, -1: the base, before the first joint): torque-like gradients
/// with their exact Hessian.
struct PoseTerm {
  int node;
  Vec6 gradient = Vec6::Zero();  ///< in (v, theta)
  Mat6 hessian = Mat6::Zero();
  Mat3 geometric = Mat3::Zero();  ///< further Hessian in theta, of terms that carry forces
};

/// A term in the rotation of one link alone, as the sweep keeps it: rows of symmetric matrices in theta.
struct TurnTerm {
  Four hessian[3];    ///< the fourth lanes are the gradient
  Four geometric[3];  ///< further Hessian of terms that carry forces; the fourth lanes are 0
};

/// A term in the points of one link's facet. In (v of node i + 1, theta of link i, u_1 of joint i, u_1 of joint i + 1),
/// in which a point between two rulings moves.
struct SurfaceTerm {
  int node;  ///< link i, one with a span
  Vec8 gradient = Vec8::Zero();
  Mat8 hessian = Mat8::Zero();
  Mat8 geometric = Mat8::Zero();  ///< further Hessian, of what carries forces
};

/// A point of the strip that feels another: it moves by v_i + theta_i x arm + slant u_1 of joint i.
struct SurfacePoint {
  int node;  ///< i
  Vec3 arm;  ///< from node i
  Vec3 slant;
  Vec3 gradient = Vec3::Zero();  ///< of all that it feels
};

/// Second derivatives of the objective in the places of two points: half of a symmetric whole, once for each pair of
/// points, and for a point with itself.
struct PointCoupling {
  int a, b;  ///< points
  Mat3 hessian = Mat3::Zero();
  Mat3 geometric = Mat3::Zero();  ///< further Hessian, of what carries forces
};

/// The same between points of two chains.
struct ChainCoupling {
  std::array<int, 2> chain;
  PointCoupling points;  ///< the first chain's and the second's
};

/// The turn of the joint by du, about the axis it has.
inline Four turn_of(const ChainLink& link, const Vec2& du) {
  return all(du[0]) * link.axis[0] + all(du[1]) * link.axis[1];
}

/// One linearised problem.
struct ChainSystem {
  std::vector<ChainLink> links;          ///< N + 1 entries; the last has no link, only joint and node
  std::vector<ChainRow> rows;            ///< probes, then constraints; each sorted by decreasing node
  std::vector<PoseTerm> pose_terms;      ///< sorted by decreasing node
  std::vector<SurfaceTerm> surfaces;     ///< at most one a link, sorted by decreasing node
  std::vector<SurfacePoint> points;      ///< in any order
  std::vector<PointCoupling> couplings;  ///< if any, the step is found by a sparse factorisation instead of the sweep
  std::vector<TurnTerm> turns;           ///< (N) or none, of the links with a span
  Eigen::MatrixXd follower;              ///< (probes x probes) unsymmetric part of the Hessian, in the
                                         ///< coordinates of as many probe rows: loads without a potential
  std::array<bool, 6> base_fixed{};      ///< v (3), theta (3) of the base
  std::array<double, 2> base_shift{};    ///< added to the diagonal of the base: position, rotation
  std::array<double, 2> shift{};         ///< added to the diagonal of every 2 x 2 pivot
  std::size_t probe_count() const { return static_cast<std::size_t>(follower.rows()); }
  const std::vector<Vec2>* only_load = nullptr;  ///< (N + 1) if set, the gradient in u for which to solve instead of
                                                 ///< the objective's own: the response to a load
  bool geometric = true;                         ///< false: leave out the terms that carry forces
};

/// What a joint keeps from the backward sweep: u_i = -(v . v_i + theta . theta_{i-1} + previous u_{i-1} + ...).
struct ChainGain {
  Four v[2], theta[2];  ///< by coordinate; the fourth lane of theta belongs to the gradient
  Four previous;        ///< 2 x 2, by columns
};

struct ChainStep {
  Vec6 base = Vec6::Zero();        ///< (v_0, theta_base)
  std::vector<Vec2> u;             ///< (N + 1)
  std::vector<Vec3> v;             ///< (N + 1) displacement of the nodes
  std::vector<double> multiplier;  ///< (rows) new values
  int negative_pivots = 0;         ///< negative eigenvalues of the reduced Hessian, followers left out
};

/// Buffers; reused between calls without allocation once they have their size.
struct SparseWorkspace;
struct ChainWorkspace {
  std::vector<ChainGain> gains;
  std::vector<Four> columns;                ///< per node, 2 rows: Z^-1 times the constraint columns, four to a vector
  std::vector<Vec2> gradient;               ///< exact gradient of objective + multipliers * rows in u_i
  Vec6 base_gradient;                       ///< the same in (v_0, theta_base)
  std::shared_ptr<SparseWorkspace> sparse;  ///< only where links feel one another
};

/// Solves for the step. Returns false if a pivot or the Schur complement is singular (the step is then not
/// written); an indefinite but regular system is solved and its negative count reported.
bool chain_step(const ChainSystem& system, ChainWorkspace& work, ChainStep& step);

/// One of several chains that are solved for together.
struct ChainPart {
  const ChainSystem* system;
  ChainWorkspace* work;
  ChainStep* step;
};

/// The same for several chains at once; without couplings each by itself. Negative pivots are counted in the steps'
/// sum: those of chains that feel one another in the first.
bool chain_steps(std::span<const ChainPart> chains, const std::vector<ChainCoupling>& couplings);

}  // namespace wunderlich::math
