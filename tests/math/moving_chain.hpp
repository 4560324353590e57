/// A small nonlinear problem on a real chain of folds: an objective whose every derivative the sweep must know.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::testing {

/// Springs from every node to an anchor, link energies quadratic in u, quadratic pose terms, and multipliers times
/// rows, rotations being measured by their vector from `frame`.
struct MovingChain {
  Pose base;
  std::vector<double> hinge, span;  ///< lengths [m]
  std::vector<Vec2> u;              ///< (kappa, eta)
  std::vector<double> stiffness;
  std::vector<Vec3> anchor;
  std::vector<Vec4> link_gradient;  ///< at u = 0
  std::vector<Mat4> link_hessian;
  std::vector<math::ChainRow> rows;  ///< residuals are those at `origin`
  std::vector<math::PoseTerm> terms;
  std::vector<Vec3> origin;  ///< node positions and frames that rows and pose terms are measured from
  std::vector<Quat> frame;
  std::vector<Vec2> first;  ///< u there
  Vec3 base_origin;
};

/// A random one, rows and terms included, measured from where it is.
MovingChain random_moving_chain(int links, std::mt19937& random);

/// The chain moved by x = (v_0, theta_base, u_0, ..., u_N).
MovingChain moved(const MovingChain& chain, const Eigen::VectorXd& x);

/// Objective plus multipliers times rows.
double value(const MovingChain& chain);

math::ChainSystem system_at(const MovingChain& chain);

/// The exact gradient of `value` by the sweep, in x at 0.
Eigen::VectorXd gradient(const MovingChain& chain);

}  // namespace wunderlich::testing
