/// The chain's linearised problem as one dense KKT system: what the sweep must solve, in the plainest way.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::testing {

/// Unknowns x = (v_0, theta_base, u_0, ..., u_N).
struct DenseChain {
  Eigen::MatrixXd hessian;   ///< without what carries forces, and without followers
  Eigen::MatrixXd follower;  ///< the unsymmetric rest
  Eigen::VectorXd gradient;
  Eigen::MatrixXd jacobian;  ///< of the constraint rows
  Eigen::VectorXd residual;
  std::vector<Eigen::Index> free;  ///< unknowns that may move
};

DenseChain dense_chain(const math::ChainSystem& system);

struct DenseStep {
  Eigen::VectorXd x;           ///< 0 where fixed
  Eigen::VectorXd multiplier;  ///< of the constraint rows
  int negative = 0;            ///< eigenvalues of the Hessian on the null space of the rows
};

DenseStep solve(const DenseChain& chain);

/// That chain_step finds it: step, multipliers, and negative modes.
void expect_same(const math::ChainSystem& system, const DenseStep& dense, double tolerance);

/// The sweep's step as one vector.
Eigen::VectorXd stacked(const math::ChainStep& step);

}  // namespace wunderlich::testing
