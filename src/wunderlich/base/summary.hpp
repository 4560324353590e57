/// The result of a run as plain numbers: `summary.json` and `history.csv` are these structs, written out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich {

struct Energies {
  double elastic = 0;     ///< [J]
  double kinetic = 0;     ///< [J]
  double gravity = 0;     ///< [J]
  double normalized = 0;  ///< elastic * length / (bending_stiffness * width)
  double total() const { return elastic + kinetic + gravity; }
};

/// Largest violation of each internal constraint; rates are made dimensionless by the segment length.
struct ConstraintErrors {
  double max_length_error = 0;
  double max_parallel_error = 0;
  double max_binormal = 0;
  double max_torsion_mismatch = 0;
  double max_ruling_ratio = 0;  ///< max |w eta'/2|, below 1 while rulings do not meet
};

/// What a support exerts on the strip at one end, world axes.
struct Reaction {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< about the end node [N m]
};

struct Topology {
  double twist = 0;   ///< turns of d1 about the tangent, positive right-handed
  double writhe = 0;  ///< of the closed centerline; for an open strip of the arc itself
  double link = 0;    ///< twist + writhe
};

struct Stability {
  bool stable = false;
  int negative_modes = 0;  ///< negative eigenvalues of the reduced Hessian
};

struct Timing {
  double wall_seconds = 0;  ///< solver only, without output
  double step_us_median = 0;
  double step_us_p95 = 0;
  double iterations_mean = 0;
  std::vector<std::pair<std::string, double>> phases;  ///< seconds by phase of the path
};

/// One recorded step.
struct HistoryRow {
  double time = 0;
  Energies energy;
  ConstraintErrors constraints;
  double area_error = 0;
  int iterations = 0;
  double step_us = 0;
};

/// With solids, and of the strip with itself; beyond the thickness that is kept.
struct ContactSummary {
  int count = 0;                ///< points and pairs within the distance at which forces begin, at the end
  double max_penetration = 0;   ///< largest at any step [m]
  double minimum_distance = 0;  ///< smallest at any step [m]
};

struct Summary {
  std::string scene;
  std::string model = "ribbon";
  std::string method;
  bool converged = false;
  std::string failure;  ///< why it did not converge; empty when it did
  int segments = 0;
  double time = 0;
  int steps = 0;
  Energies energy;
  ConstraintErrors constraints;
  double area_error = 0;
  Timing timing;
  std::optional<ContactSummary> contact;
  std::optional<double> closure_error;  ///< loops: relative to the length
  std::vector<Reaction> ends;           ///< start, end; empty for loops
  std::optional<Stability> stability;   ///< equilibria
  std::optional<double> imbalance;      ///< equilibria: largest moment left in a joint [N m]; for comparisons
  Topology topology;
  std::vector<double> kappa_zeros;  ///< u / length
  std::vector<std::string> warnings;
};

}  // namespace wunderlich
