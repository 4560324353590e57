/// A small complementarity problem with Coulomb cones, by projected Gauss-Seidel with Newton's steps between.
#pragma once

#include <vector>

namespace wunderlich::solver::two_stage {

/// w = b + A (x - x0); for each single row x >= 0, w >= 0, x w = 0. A row with friction has two tangential rows after
/// it, whose x is kept within mu times its own, against w: none while it may hold, against it when it slides.
struct ConeProblem {
  int size = 0;
  std::vector<double> matrix;    ///< (size x size) A, symmetric, positive semidefinite
  std::vector<double> slack;     ///< (size) b on entry, w on return
  std::vector<double> force;     ///< (size) x0 on entry, x on return
  std::vector<double> friction;  ///< (size) mu of a row that has tangential ones; -1 of those
  // buffers
  std::vector<int> rows;
  std::vector<double> system, rhs, force_kept, slack_kept;
};

/// Sweeps taken, and whether they were cut off at their limit.
struct ConeReport {
  int sweeps = 0;
  bool capped = false;
};

/// Until a sweep changes no w by more than `tolerance`. Sweeps find out what touches, holds and slides; the equations
/// of that are then solved at once, since sweeps alone are slow where rows say nearly the same. Where Newton's steps do
/// not help, `enough` will do.
ConeReport solve_cones(double tolerance, double enough, int max_sweeps, ConeProblem& problem);

/// The force of a friction disc nearest to (a, b).
void put_into_disc(double radius, double& a, double& b);

}  // namespace wunderlich::solver::two_stage
