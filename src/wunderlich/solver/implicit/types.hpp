/// What the implicit method is told (options), what it moves (state) and what it says (report).
#pragma once

#include <string>
#include <vector>

#include "wunderlich/solver/equilibrium.hpp"
#include "wunderlich/solver/implicit/inertia.hpp"

namespace wunderlich::solver::implicit {

constexpr int kDampingLevels = 4;  ///< of what a step does not resolve

struct Options {
  Integrator integrator = Integrator::generalised_alpha;
  KineticEnergy kinetic = KineticEnergy::rotary;
  double tolerance = 1e-6;  ///< on Newton's last step (which is taken): rotation [rad], displacement / length
  int max_iterations = 40;  ///< of one minimisation; four times as many once a step is short
  double barrier = 1e-3;    ///< e1 of the ruling barrier: rulings have no mass, and in a flat strip no stiffness
  double drag_tangent = 0;  ///< rate [1/s] at which the velocity along the tangent decays, as in air
  double drag_normal = 0;   ///< the same across it
  double viscosity = 0;     ///< of the material: time by which stress lags behind bending (Kelvin-Voigt) [s]
  bool conserve = false;    ///< correct the velocities so that energy, and momenta of a free strip, are kept exactly;
                            ///< of one strip alone
  double error = 0;         ///< local error of a step that is accepted, over the length; 0: any
};

/// One strip of a motion.
struct StripState {
  PathState path;  ///< joint coordinates, multipliers, carried frames; phase `load`, t the time [s]
  Points points;
  geometry::Chain before;                         ///< joint coordinates a step earlier, for the prediction
  Momentum momentum;                              ///< `conserve`: at the start
  math::Vec6 base_reaction = math::Vec6::Zero();  ///< of a held base: force and torque
};

/// What a checkpoint must hold for a run to go on bit for bit.
struct State {
  std::vector<StripState> strips;
  double last_step = 0;  ///< [s]; 0 before the first, and after a release or an impulse
  int level = 0;         ///< of damping: 0 ... kDampingLevels - 1
  int calm = 0;          ///< steps since it was raised
  double elastic = 0;    ///< energy with all barriers, now [J]
  double peak = 0;       ///< largest kinetic energy so far [J]
  double missing = 0;    ///< `conserve`: energy that is still to be put right [J]
  double time() const { return strips.front().path.t; }
};

struct StepReport {
  bool accepted = false;
  std::string failure;     ///< why not; empty if accepted
  NewtonReport newton;     ///< of the last minimisation
  int iterations = 0;      ///< of all
  int repeats = 0;         ///< minimisations thrown away, because the energy grew
  bool inelastic = false;  ///< taken by Euler: an impulse, of a support that starts or a strip that comes taut
  double nearest = 1e9;    ///< distance of the nearest point to a solid, or of two parts of strips [m]
  int touching = 0;        ///< points and pairs that feel something
  double error = 0;        ///< estimate of the local error over the length
};

}  // namespace wunderlich::solver::implicit
