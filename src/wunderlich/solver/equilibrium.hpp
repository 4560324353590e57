/// Equilibria from a flat straight strip, along a loading path: bend, twist, close, or follow the supports.
///
/// A path is a sequence of steps between accepted states. `advance` takes one step and either accepts a converged
/// state or leaves the path where it was and says why; nothing else is kept between steps, so a stored PathState
/// goes on exactly as an uninterrupted run.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/solver/newton.hpp"

namespace wunderlich::solver {

/// How the path of a closed loop starts.
enum class LoopPath {
  automatic,  ///< planar for two half twists, else twist
  twist,      ///< bend to a ring, turn one end, close
  planar,     ///< kappa = A cos(2 pi u / l), A from 0 to 15.1 / l: the figure-eight, without contact
};

struct PathOptions {
  energy::Model model;
  LoopPath loop_path = LoopPath::automatic;
  double duration = 1;  ///< load parameter at the end
  int steps = 0;        ///< load steps; 0: chosen from the motion
  double tolerance = 1e-10;
  int max_iterations = 2000;  ///< of one minimisation
  double barrier = 1e-9;      ///< e1 of the ruling barrier
};

/// What does not change along the path.
struct PathProblem {
  geometry::Ribbon ribbon;
  geometry::Ribbon cut;  ///< loops: the same strip before it is closed, both ends clamped; else = ribbon
  constraint::Surroundings surroundings;
  PathOptions options;
};

/// bend, twist and close make a loop of the flat strip, and where it feels itself relax lets it come to rest; approach
/// brings supports and loads from where the strip is to where they are at t = 0; load follows them in time; settle ends
/// at a static minimum.
inline constexpr double kSettleTime = 0.05;  ///< that settling takes on the clock of the path, for the film
enum class Phase { bend, twist, close, relax, approach, load, settle, done };
const char* phase_name(Phase phase);

/// Where the path stands: everything a checkpoint needs.
struct PathState {
  Phase phase = Phase::approach;
  double t = 0;            ///< load parameter, or share of the phase
  double dt = 0;           ///< step under way; halved on failure
  double clock = 0;        ///< path parameter run through so far, over all phases; grows with every step
  int steps = 0;           ///< accepted so far
  int iterations = 0;      ///< Newton iterations so far, failed attempts included
  int negative_modes = 0;  ///< at the last minimisation
  int touching = 0;        ///< points and pairs of parts of the strip that feel a solid or each other
  double nearest = 1e9;    ///< smallest distance of these so far, beyond the thickness [m]
  bool closed = false;     ///< `chain` is of `ribbon`; before a loop closes it is of `cut`
  geometry::Chain chain;
  std::vector<double> multipliers;
  std::vector<Pose> origin;       ///< one a support: the strip's own pose there when the approach began
  std::vector<Quat> transported;  ///< one a support: the strip's own frame there at the last step
};

struct PathStep {
  bool accepted = false;
  int iterations = 0;      ///< of this step
  NewtonReport newton;     ///< of the last minimisation
  bool exhausted = false;  ///< a further attempt would fail as well: the step cannot be shortened any more
  std::string failure;     ///< why it was not accepted: what, where, likely cause
};

/// All that a path needs; for a loop also the strip before it is closed, both ends clamped.
PathProblem make_path(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings,
                      const PathOptions& options);

/// The flat straight strip at the start of the path.
PathState start_path(const PathProblem& problem);

/// One accepted step further, or a failure that leaves `state` as it was (but for its iteration count).
PathStep advance(const PathProblem& problem, PathState& state, NewtonWorkspace& work);

/// Does the loop's path stay in the plane until it closes.
bool is_planar(const PathProblem& problem);

/// Rough share of the path that is done, for progress.
double fraction_done(const PathProblem& problem, const PathState& state);

/// The ribbon that `state.chain` belongs to.
const geometry::Ribbon& ribbon_of(const PathProblem& problem, const PathState& state);

/// Elastic energy of a chain [J].
double elastic_energy(const geometry::Ribbon& ribbon, const energy::Model& model, const geometry::Chain& chain);

/// What the supports exert on the strip at its start and end, world axes; about the end nodes.
struct EndReactions {
  std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, 2> torque{Vec3::Zero(), Vec3::Zero()};
};
EndReactions end_reactions(const PathProblem& problem, const PathState& state, NewtonWorkspace& work);

/// What is out of balance where the path stands: the largest gradient of energy, loads and reactions by the turn of a
/// joint, by the slope of its ruling, or by the pose of a free base (there of forces times the width) [N m]. Empty
/// where the linearised problem is singular.
std::optional<double> joint_imbalance(const PathProblem& problem, const PathState& state, NewtonWorkspace& work);

}  // namespace wunderlich::solver
