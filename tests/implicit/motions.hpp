/// Ribbons in motion that the tests of the implicit method share.
#pragma once

#include <string>

#include "solver/paths.hpp"
#include "wunderlich/solver/implicit/implicit.hpp"

namespace wunderlich::testing {

namespace implicit = solver::implicit;

/// A strip with its problem, options and state, and what its steps have cost so far.
struct Motion {
  solver::PathProblem path;
  implicit::Options options;
  implicit::State state;
  implicit::Workspace work;
  int steps = 0, iterations = 0, halvings = 0, repeats = 0, impulses = 0;
  int deepest = 0;      ///< halvings of the most divided step
  std::string failure;  ///< of the last step that was not accepted
};

/// Length 0.3, width 0.03, rho 0.1, 50 segments; with a frame at its start if clamped.
geometry::RibbonSpec sheet(double bending_stiffness, bool clamped);

/// A clamp at a node that holds the undeformed strip where it is.
constraint::Support level_clamp(const geometry::RibbonSpec& spec, int node);

Motion make_motion(const geometry::RibbonSpec& spec, const constraint::Surroundings& surroundings,
                   double barrier = 1e-3);

/// The sheet clamped along +x at its start, straight and at rest, under 9.81 that is tilted out of the plane of
/// bending by `tilt` [rad].
Motion swing(double bending_stiffness, double tilt);

/// A sheet of D = 2.7e-4 bowed between two clamps, one of which begins to move and to turn: 0.06 in and 2 rad in 0.3 s.
/// (Flat, it could neither be pushed together nor twisted at a finite speed.)
Motion between_clamps();

/// Sets the strip going from a shape, the straight one if none is given.
void start(Motion& motion);
void start(const geometry::State& shape, const Vec3& spin, Motion& motion);
void start(const geometry::Chain& chain, Motion& motion);

/// One step to t1, halved up to 8 times where it is not accepted; false if that does not help.
bool move_to(double t1, Motion& motion);

double kinetic(const Motion& motion);
/// Elastic energy with the barrier, kinetic energy and gravity's [J].
double total_energy(const Motion& motion);

/// Largest error of the internal constraints; of the area; and the largest |x|.
struct Exactness {
  double internal = 0, area = 0, ruling = 0;
};
/// Adds the errors of the motion's present shape.
void look(const Motion& motion, Exactness& worst);
/// What is asked: 1e-12, 1e-10, and rulings that do not meet.
void expect_exact(const Exactness& worst);

/// Prints a figure beside the one asked for, and keeps it with the test's results.
void show(const std::string& name, double measured, double asked);

}  // namespace wunderlich::testing
