/// Newton's step on chains whose links feel one another, by a sparse factorisation. Internal to math/.
///
/// Poses stay unknowns beside the joints' coordinates, and what a joint and a span do to them are constraints with
/// multipliers: the matrix is a band with a few blocks off it, one for each pair of links that touch.
#pragma once

#include <vector>

#include "wunderlich/math/block_ldlt.hpp"
#include "wunderlich/math/chain_sweep.hpp"
#include "wunderlich/math/repeated_matrix.hpp"

namespace wunderlich::math {

/// Unknowns of one node in the matrix; -1 where there are none.
struct NodePlaces {
  int v = -1;      ///< displacement of the node
  int theta = -1;  ///< turn of its link
  int u = -1;      ///< the joint's two coordinates
  int turn = -1;   ///< multipliers of theta_i = theta_{i-1} + axes u_i
  int move = -1;   ///< multipliers of v_i = v_{i-1} + theta_{i-1} x span_{i-1}
};

/// Adjoint wrench of the chain at one node: what its joint and the span before it carry.
struct NodeWrench {
  Vec3 torque;      ///< on link i at its node, everything beyond included
  Vec3 force;       ///< on node i
  Vec2 gradient;    ///< exact, in u_i
  double pull = 0;  ///< the part of it in u_1 that the torque and forces on surfaces exert
};

/// One chain's share of the matrix.
struct ChainUnknowns {
  std::vector<NodePlaces> places;
  int theta_base = -1, first_row = -1;
  std::vector<NodeWrench> wrench;
};

struct SparseWorkspace {
  std::vector<int> key;  ///< what the pattern depends on
  std::vector<ChainUnknowns> chains;
  int size = 0;
  std::vector<char> fixed;
  RepeatedMatrix matrix;
  BlockFactor factor;
  Eigen::VectorXd right, solution, rest;
};

/// Forces and torques that each joint and span carries, and the exact gradient.
void find_wrenches(const ChainSystem& system, std::vector<NodeWrench>& wrenches, Vec6& base_gradient);

/// Fills matrix and right-hand side, in an order that the work's key decides.
void assemble(std::span<const ChainPart> chains, const std::vector<ChainCoupling>& couplings, SparseWorkspace& work);

/// As chain_steps, for chains with couplings in themselves or between them; no followers.
bool sparse_chain_steps(std::span<const ChainPart> chains, const std::vector<ChainCoupling>& couplings);

/// The same for one.
bool sparse_chain_step(const ChainSystem& system, ChainWorkspace& work, ChainStep& step);

}  // namespace wunderlich::math
