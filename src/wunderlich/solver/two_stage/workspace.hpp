/// Buffers of a two-stage step and the tables that one step sets up: who is held, which hinge a node shows.
#pragma once

#include <vector>

#include "wunderlich/energy/link_terms.hpp"
#include "wunderlich/geometry/chart.hpp"
#include "wunderlich/geometry/state.hpp"
#include "wunderlich/math/banded.hpp"
#include "wunderlich/math/lbfgs.hpp"
#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/two_stage/cone_solve.hpp"
#include "wunderlich/solver/two_stage/contact_pairs.hpp"
#include "wunderlich/solver/two_stage/range_space.hpp"
#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::solver::two_stage {

/// What a node shows of its hinge. Node 0 of a loop shows the seam's, seen from the start, which reverses kappa and
/// gamma where the surface turns over; its last node's eta is that of node 0, with the same sign.
struct NodeView {
  int hinge = -1;   ///< index into the hinges; -1 at a free end
  double sign = 1;  ///< of kappa
  int eta = 0;      ///< node whose eta this is
  double eta_sign = 1;
};

/// Who is held in this step.
struct Holding {
  std::vector<Vec3> inverse_mass;  ///< (nodes) by world axis [1/kg]; 0 where held; a loop's last node is its first
  std::vector<Vec3> target;        ///< (nodes) [m]; meaningful where held
  std::vector<char> frame_held;    ///< (segments)
  std::vector<char> eta_held;      ///< (nodes) ends of an open strip with straight ends
};

struct Workspace {
  // set up once a step
  std::vector<geometry::Hinge> hinges;
  std::vector<NodeView> views;  ///< (nodes)
  Holding holding;
  std::vector<Vec3> torque;        ///< (segments) world [N m]
  std::vector<Quat> torque_frame;  ///< (segments) frames from which the torque's work counts
  std::vector<Quat> carried;       ///< (segments) frames carried from the step's start, with their spin
  std::vector<double> inertia;     ///< (segments) weight of E_I [J]
  double parallel_weight = 0;      ///< [J]

  // stage ode
  std::vector<Vec3> r_start, force;
  math::BandedMatrix length;
  std::vector<double> length_rhs;

  // stage opt
  std::vector<Vec3> strain;              ///< (hinges) gamma, kappa, tau [1/m]
  std::vector<geometry::HingeJet> jet;   ///< (hinges)
  std::vector<energy::LinkTerms> links;  ///< (segments) energies at the last gradient
  std::vector<Vec3> hinge_slope;         ///< (hinges) dV/dstrain
  std::vector<double> kkt_rhs;
  math::BandedMatrix system, factored;
  std::vector<double> gradient, previous_gradient, step, correction, previous_step;
  std::vector<double> residual;  ///< (2 a hinge) gamma h, (kappa eta - tau) h
  std::vector<Quat> q_start, lbfgs_q;
  std::vector<double> eta_start, lbfgs_eta, gradient_change;
  RangeSpace range;

  // stage contact
  ContactProblem solids_before, solids;  ///< at both ends of the substep
  double point_margin = 0;               ///< that points keep beyond the thickness [m]
  Corners corners;
  std::vector<Touch> touches;
  std::vector<double> gaps, ruling_gaps, line_gaps;  ///< of the points of a facet, least by ruling, of one ruling
  Equations equations;
  std::vector<Row> contact_rows;
  ConeProblem cones;
  std::vector<double> force_before;
  std::vector<double> reduced, coupling;  ///< D^-1/2 L^-1 of the equations' residuals, of J_e W^-1 J^T
  std::vector<int> coupling_start;
  std::vector<Vec7> motion;
  std::vector<Vec3> edge_start;

  math::Lbfgs memory;
  State trial;
  geometry::State before;
  Drive sub_drive;
};

}  // namespace wunderlich::solver::two_stage
