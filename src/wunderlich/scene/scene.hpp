/// A scene: what a user writes in a file, checked and in SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/energy/model.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/solver/equilibrium.hpp"
#include "wunderlich/solver/implicit/types.hpp"
#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::scene {

enum class Method { implicit, two_stage, equilibrium };

/// "implicit", "two-stage", "equilibrium": as scenes and summaries say it.
const char* method_name(Method method);

using solver::LoopPath;

struct SolverOptions {
  Method method = Method::implicit;
  energy::Model energy;
  LoopPath loop_path = LoopPath::automatic;
  double duration = 1;        ///< load parameter at the end of the path [s]
  int steps = 0;              ///< load steps of the path; 0: as few as it takes
  double tolerance = 1e-10;   ///< equilibria: on the Newton step, rotation [rad] and displacement / length
  int max_iterations = 2000;  ///< Newton iterations of one minimisation
  double barrier = 1e-9;      ///< e1 of the final ruling barrier, see solver::ChainProblem
  double time_step = 0.01;    ///< dynamics [s]
  bool stop_at_rest = false;  ///< dynamics: end before `duration` once nothing moves
  solver::implicit::Options implicit;
  solver::two_stage::Options two_stage;
};

enum class InitialShape {
  straight,     ///< undeformed
  coil,         ///< constant curvature and ruling slope
  profile,      ///< both linear between given places
  closed,       ///< a loop where its path has just closed it
  equilibrium,  ///< at rest under the supports and loads of time 0
};

/// How a strip is bent at one place.
struct ProfileRow {
  double at = 0;         ///< arc length over length
  double curvature = 0;  ///< of the centerline [1/m]
  double slope = 0;      ///< eta
};

/// Where a motion starts.
struct InitialState {
  InitialShape shape = InitialShape::straight;
  double radius = 1;          ///< of a coil [m]
  double slope = 0;           ///< eta of a coil
  std::optional<Pose> place;  ///< where a strip that nothing holds has its first node and segment
  std::vector<ProfileRow> profile;
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3 spin = Vec3::Zero();      ///< about the center of mass [rad/s]
};

struct OutputOptions {
  int frames = 60;      ///< at most so many recorded frames
  int subdivision = 3;  ///< rendered strips per segment along the length (the paper's Fig. 6: 3)
  int across = 8;       ///< rendered quads across the width
  std::vector<std::string> formats{"vtp", "glb", "svg", "html", "png"};  ///< files beside the tables
};

/// How the models beside the ribbon are built.
struct CompareOptions {
  struct Shell {
    int along = 0, across = 0;  ///< vertices
    double time_step = 0;       ///< [s]
  };
  int rod_segments = 0;
  bool paper_ratio = false;  ///< the rod's stiffnesses as 10^4 : 1 : 2, else of a rectangle
  double thickness = 0;      ///< of the rod [m]
  double poisson_ratio = 0.3;
  Shell conforming, nonconforming;
  double length_tolerance = 0.01;  ///< of shells, relative
  bool implicit_metric = false;    ///< of shells: of M + h^2 K, else of their masses
  double time_step = 0;            ///< of the rod [s]
  double load_time = 0;            ///< of a unit of the load parameter, for models that move to an equilibrium [s]
  double settle_time = 0;          ///< and at most until they are at rest [s]
  double damping = 0;              ///< [1/s]; of the rod across its tangent
  double damping_tangent = 0;      ///< of the rod along it [1/s]
};

struct Scene {
  std::string name;
  std::string title;     ///< one line, for `wunderlich scenes`
  std::string written;   ///< the scene as YAML before overrides
  std::string resolved;  ///< the same after all overrides: what `--resume` runs again
  geometry::RibbonSpec ribbon;
  double thickness = 0;  ///< of the material [m]; 0: not given
  constraint::Surroundings surroundings;
  std::vector<std::string> obstacle_places;  ///< where each was written, `file:line:column: key`, for messages
  std::string contact_place;                 ///< the same of `contact`
  InitialState initial;
  SolverOptions solver;
  OutputOptions output;
  CompareOptions compare;
  std::string ribbon_name;    ///< of several: what this one is called; empty otherwise
  std::vector<Scene> beside;  ///< further strips: the same scene with another ribbon, and what holds it
};

/// The strips of a scene: itself, and those beside it.
std::vector<const Scene*> strips_of(const Scene& scene);

}  // namespace wunderlich::scene
