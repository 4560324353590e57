/// A small nonlinear problem on a real chain of folds: an objective whose every derivative the sweep must know.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::testing {

/// A spring between two points of the strip, at v across it: half of the square of their way apart less `rest`.
struct Spring {
  int a, b;       ///< nodes
  double va, vb;  ///< [m]
  Vec3 rest;
};

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
  std::vector<Spring> springs;
  std::vector<Vec3> origin;  ///< node positions and frames that rows and pose terms are measured from
  std::vector<Quat> frame;
  std::vector<Vec2> first;  ///< u there
  Vec3 base_origin;
};

/// A random one, rows and terms included, measured from where it is.
MovingChain random_moving_chain(int links, std::mt19937& random);

/// Springs between its links, which only the sparse factorisation knows.
void add_random_springs(int count, std::mt19937& random, MovingChain& chain);

/// The chain moved by x = (v_0, theta_base, u_0, ..., u_N).
MovingChain moved(const MovingChain& chain, const Eigen::VectorXd& x);

/// Objective plus multipliers times rows.
double value(const MovingChain& chain);

math::ChainSystem system_at(const MovingChain& chain);

/// The exact gradient of `value` by the sweep, in x at 0.
Eigen::VectorXd gradient(const MovingChain& chain);

/// The Hessian of `value`, by differences of fourth order of the exact gradient, brought into the chart at the start.
Eigen::MatrixXd difference_hessian(const MovingChain& chain);

}  // namespace wunderlich::testing
