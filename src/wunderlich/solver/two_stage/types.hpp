/// What the two-stage method is told (options, drive), what it moves (state) and what it says (report).
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "wunderlich/base/summary.hpp"
#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::solver::two_stage {

/// How stage opt goes down.
enum class Minimiser {
  newton,  ///< on the Lagrangian of Eq. 21 with its constraints, one banded solve an iteration
  lbfgs,   ///< one L-BFGS step without constraints, then the projection of Eq. 22, and again   @eq Shen2015:21
};

/// How Eq. 22 is solved after an L-BFGS step.
enum class Projection {
  direct,        ///< banded solve; the ruling bound by an active set
  gauss_seidel,  ///< partial projected Gauss-Seidel, capped   @eq Shen2015:22
};

/// Where w_para = alpha |K_D| / dim K takes its K.   @eq Shen2015:5.1
enum class ParallelWeight {
  rest,   ///< the flat strip: constant through a run, so the stability bound is known
  state,  ///< the state at the step's start, as the paper seems to mean; allocates
};

/// Which damping of the velocity follows stage ode.
enum class Damping {
  rate,      ///< exp(-rate dt): the same motion whatever the step
  per_step,  ///< the paper's factors mu_t, mu_nt, once a step
};

/// What stands for the inertia of the turn about the centerline, which stage opt would otherwise lose.
enum class TorsionalInertia {
  off,
  physical,  ///< carries the last turn on, with a weight that grows with rho w^3 l/12
  printed,   ///< with the printed weight, which falls with it   @eq Shen2015:5.1
};

struct OdeOptions {
  double weight_scale = 10;  ///< alpha, in [10, 100]
  ParallelWeight weight = ParallelWeight::rest;
  Damping damping = Damping::rate;
  double damping_tangent = 0;       ///< rate [1/s] along the tangent
  double damping_normal = 0;        ///< rate [1/s] across it
  double factor_tangent = 0.85;     ///< mu_t of `per_step`
  double factor_normal = 0.98;      ///< mu_nt of `per_step`
  double length_tolerance = 1e-10;  ///< |e|/l - 1 after the fast projection
  int max_projections = 100;
};

struct OptOptions {
  Minimiser minimiser = Minimiser::newton;
  Projection projection = Projection::direct;
  double barrier = 1e-3;      ///< e1 of -ln(1 - x^2) in the objective; 0: the bound is a constraint alone
  double proximal = 1e-2;     ///< mu of (mu/2) D (l/w) sum (eta - eta of the last step)^2: holds rulings where kappa
                              ///< vanishes and nothing else does; no bias at rest
  bool central_rate = false;  ///< eta' by the central difference of Eq. 10 (only with lbfgs)
  double step_size = 1;       ///< h of an L-BFGS step; 0.03 to 0.05 in the paper's Table 1
  int max_iterations = 50;
  double gradient_change = 0.01;       ///< lbfgs stops when the gradient changes by less than this share of the first
  double step_tolerance = 1e-6;        ///< newton stops after a step below this [rad]
  double constraint_tolerance = 1e-6;  ///< on gamma and kappa eta - tau times the hinge's length
  int max_sweeps = 2000;               ///< of Gauss-Seidel in one linear solve
  int max_projections = 20;            ///< Newton iterations of one projection
  double flat_curvature = 1e-9;        ///< |kappa| w below which a hinge is flat and Eq. 8 sets its ruling
  bool accept_inexact = false;         ///< accept a step whose constraints did not reach the tolerance
};

/// What measures a motion in a contact.   @eq Shen2015:22
enum class ContactMetric {
  physical,  ///< masses; of frames what E_para and the inertia of the turn hold them with, of rulings D l/w
  printed,   ///< masses of velocities, |dq|^2 and |d eta|^2: mixes units
};

struct ContactOptions {
  ContactMetric metric = ContactMetric::physical;
  int max_rounds = 30;             ///< of finding what touches and projecting
  double most_penetration = 0.01;  ///< share of the width beyond which a step fails
};

struct Options {
  energy::Model model;
  OdeOptions ode;
  OptOptions opt;
  ContactOptions contact;
  TorsionalInertia inertia = TorsionalInertia::physical;
  double inertia_scale = 1;   ///< Gamma, in [0, 1]
  bool substeps = true;       ///< divide a step that exceeds the stability bound
  double bound_safety = 0.9;  ///< share of the bound that a substep may take
};

/// The scheme as printed: central eta', printed strains, series of order 5, fixed L-BFGS step, Gauss-Seidel, damping
/// per step, no substeps.
Options printed_options();

/// A support where it stands at the step's end. `full` at an end node of an open strip (segment -1, that end of the
/// ribbon clamped) prescribes the node's own frame; anywhere else the frame is that of a segment.
struct Support {
  int node = 0;
  std::array<bool, 3> hold_position{true, true, true};  ///< world x, y, z
  Vec3 position = Vec3::Zero();                         ///< [m]
  constraint::Orientation orientation = constraint::Orientation::full;
  int segment = -1;               ///< -1: the end node's own frame; about_tangent: its segment
  Quat frame = Quat::Identity();  ///< of `full`
  double turn = 0;                ///< of `about_tangent`: prescribed turn about d3 during the step [rad]
};

struct Load {
  int node = 0;
  Vec3 force = Vec3::Zero();   ///< world [N]
  Vec3 torque = Vec3::Zero();  ///< world [N m]; on the segments beside the node
};

/// Everything imposed from outside during one step.
struct Drive {
  std::vector<Support> supports;
  std::vector<Load> loads;
  Vec3 gravity = Vec3::Zero();                             ///< [m/s^2]
  const constraint::Surroundings* surroundings = nullptr;  ///< whose obstacles are met, at the state's own time, and
                                                           ///< how the strip meets them and itself; no more of it is
                                                           ///< read; nullptr: nothing is met
};

/// What a checkpoint must hold for a run to go on bit for bit.
struct State {
  geometry::State shape;
  std::vector<double> spin;         ///< (segments) turn about the tangent of the last step [rad/s]
  std::vector<double> multipliers;  ///< (2 a node) of c_gamma, c_stau: where Newton starts
};

struct StepReport {
  bool accepted = false;
  std::string failure;  ///< why not; empty if accepted
  int substeps = 0;
  double stable_step = 0;      ///< 2/sqrt(38.4 alpha D/(rho l^4)) of the weight in use [s]
  bool exceeds_bound = false;  ///< a substep was longer than that
  double parallel_weight = 0;  ///< w_para [J]
  int length_iterations = 0;   ///< of the fast projection
  int iterations = 0;          ///< of stage opt
  bool converged = false;      ///< stage opt met its stopping rule in every substep
  int projections = 0;         ///< Newton iterations of Eq. 22
  int sweeps = 0;              ///< of Gauss-Seidel
  int capped = 0;              ///< times Gauss-Seidel reached its cap
  int cuts = 0;                ///< steps of the minimiser that were shortened
  int shifts = 0;              ///< Hessians that had to be made positive
  int flattened = 0;           ///< rulings set by the flat-region rule of Eq. 8
  double gradient_change = 0;  ///< at the last iteration of stage opt
  int contact_rounds = 0;      ///< linearisations of stage contact
  int contact_sweeps = 0;      ///< of its Gauss-Seidel
  int contact_capped = 0;      ///< times that reached its cap
  int contact_unsettled = 0;   ///< substeps whose contacts did not settle to the tolerance
  int touching = 0;            ///< points and pairs that push in the last substep
  double nearest = std::numeric_limits<double>::infinity();  ///< smallest distance to a solid in the step, or of parts
                                                             ///< of the strip, a bound from below, beyond the
                                                             ///< thickness [m]
  Vec3 push = Vec3::Zero();                                  ///< what solids exert on the strip in the last substep [N]
  ConstraintErrors constraints;
  double contact_seconds = 0;
  double ode_seconds = 0, opt_seconds = 0, other_seconds = 0;
};

}  // namespace wunderlich::solver::two_stage
