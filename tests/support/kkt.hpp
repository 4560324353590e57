/// The oracle: equilibrium of a ribbon in maximal coordinates, constraints by multipliers, matrices assembled whole.
///
/// Stationary points of  V + barrier + gravity - loads + lambda . c  in the chart (r, theta, eta) of
/// geometry/chart.hpp, c being parallel, binormal, torsion match, end rulings, loop closure and the supports. Slow and
/// plain; it shares nothing with the sweep in joint coordinates but the ribbon, so that the two can check each other.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::testing::kkt {

struct Problem {
  geometry::Ribbon ribbon;
  energy::Model model;
  /// Supports anywhere; forces at any node; torques and material loads at free ends only. A loop needs a support
  /// that takes its rigid motion, else the matrix is singular.
  constraint::Surroundings surroundings;
  double barrier = 1e-6;  ///< e1
  double time = 0;        ///< at which supports and loads are taken
};

struct Solution {
  geometry::State state;
  Eigen::VectorXd multipliers;  ///< one a constraint row; minus these are what constraints exert on the ribbon
  bool converged = false;
  int iterations = 0;
  double last_step = 0;  ///< largest of |theta| [rad], |dr|/length, |dx| in the last iteration
};

/// Newton with bounded steps from a state that is nearly an equilibrium: it polishes, it does not search.
Solution solve(const Problem& problem, const geometry::State& start, double tolerance = 1e-11, int max_iterations = 60);

/// Gradient of the Lagrangian, constraint residuals, and the matrix of their derivatives.
struct System {
  Eigen::VectorXd gradient;  ///< in the chart, multipliers included
  Eigen::VectorXd residual;
  Eigen::SparseMatrix<double> matrix;  ///< (chart + rows) square; symmetric unless loads follow or twist
  Eigen::MatrixXd hessian() const;     ///< its upper left block, symmetric part
  Eigen::MatrixXd jacobian() const;    ///< its lower left block
};
System assemble(const Problem& problem, const geometry::State& state, const Eigen::VectorXd& multipliers);

/// First-order change of an equilibrium under a small generalized force.
struct Response {
  Eigen::VectorXd chart;  ///< increments of r, eta, theta
  Eigen::VectorXd multipliers;
  std::vector<double> kappa;  ///< (segments + 1) by node, 0 where there is no hinge
};
/// `force` has chart size: force on nodes [N], torque on segments about their own axes [N m].
Response response(const Problem& problem, const Solution& solution, const Eigen::VectorXd& force);

/// Eigenvalues of the Hessian on the null space of the constraints.
struct Inertia {
  int negative = 0;
  int rank_loss = 0;            ///< constraint rows that depend on the others to first order
  Eigen::VectorXd eigenvalues;  ///< increasing; units are mixed, only signs mean something
};
Inertia inertia(const Problem& problem, const Solution& solution);

/// Force the first pin at `node` exerts on the ribbon, world axes, 0 along axes it leaves free [N].
Vec3 pin_force(const Problem& problem, const Solution& solution, int node);

}  // namespace wunderlich::testing::kkt
