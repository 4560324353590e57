/// Several models run on one scene, as plain numbers and pictures: what `wunderlich compare` writes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/base/summary.hpp"

namespace wunderlich {

/// How far a surface is from an isometry of the flat strip.
struct IsometryErrors {
  double area = 0;      ///< relative change of the area
  double diagonal = 0;  ///< largest relative change of length of a material line at 45 degrees, in any triangle
  double rim = 0;       ///< relative change of length of the rim where it is larger
};

/// What became of one model.
struct ModelResult {
  std::string model;       ///< ribbon, rod, shell-conforming, shell-nonconforming
  std::string method;      ///< equilibrium, implicit, two-stage, implicit-euler
  std::string resolution;  ///< "35 segments", "36 x 4 vertices"
  bool converged = false;
  std::string failure;             ///< why it did not converge; empty when it did
  std::vector<std::string> notes;  ///< what a reader of the figures should know
  int unknowns = 0;                ///< scalars that are solved for
  int constraints = 0;             ///< scalar equations that hold them together, supports left out
  Energies energy;
  IsometryErrors isometry;
  /// Of a model that says it is at rest: largest net force on one of its points, over D/w; of the ribbon, largest
  /// moment left in a joint, over D.
  std::optional<double> imbalance;
  double length_error = 0;  ///< shells: largest relative error of a length that is a constraint, at the end
  double missed_steps = 0;  ///< shells: share of the steps whose lengths stayed off by more than the tolerance
  long steps = 0;
  double step_us = 0;        ///< median of a step
  double iterations = 0;     ///< mean of a step
  double wall_seconds = 0;   ///< of all steps
  double moved_seconds = 0;  ///< time that the motion took in the model's world; 0: a path of equilibria
  std::vector<std::pair<std::string, double>> phases_us;  ///< parts of a step, means
  std::vector<Frame> frames;                              ///< at least one; centerlines may be empty
};

struct Comparison {
  std::string scene, title;
  std::string scene_text;  ///< after all overrides
  std::vector<ModelResult> models;
  std::vector<std::vector<Body>> bodies;  ///< obstacles at each model's frames
};

}  // namespace wunderlich
