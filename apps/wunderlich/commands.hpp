/// The commands of the program. Each returns the exit code; bad input is an InputError, which `main` reports.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace wunderlich::app {

enum ExitCode { done = 0, bad_input = 2, not_converged = 3, interrupted = 130 };

struct RunArguments {
  std::string scene;
  std::string out;  ///< empty: out/<scene>
  std::vector<std::string> set;
  std::optional<std::string> formats;  ///< none: those of the scene
  bool resume = false;
  bool quiet = false;
};

int run_command(const RunArguments& arguments);

int check_command(const std::string& scene, const std::vector<std::string>& set);

/// The shipped scenes, a line each.
int scenes_command();

/// docs/scene-format.md, or docs/scene.schema.json
int schema_command(bool json);

struct ExportArguments {
  std::string run;  ///< a run folder
  std::string format;
  std::string out;                  ///< empty: in the run folder, under the name `run` would give it
  std::optional<double> thickness;  ///< of a body to print [m]
  std::string size, view, colour;   ///< of a picture; empty: as it is usual
  std::optional<double> zoom;       ///< of a still or a film
  std::optional<double> fps;        ///< of a film
  std::optional<long> frame;        ///< of a still
};

int export_command(const ExportArguments& arguments);

struct SweepArguments {
  std::string sweep;  ///< a sweep file
  std::string out;    ///< empty: out/<sweep>
  std::string engine = "local";
  std::string shard;  ///< "3/8"; empty: all
  int jobs = 0;       ///< processes; 0: one a core, on Slurm one a shard
  bool retry = false;
  std::size_t shards = 0;
  std::string walltime, partition;
  bool no_requeue = false;
  std::vector<std::string> sbatch;
  bool quiet = false;
};

int sweep_command(const SweepArguments& arguments);
int sweep_status_command(const std::string& folder);
int sweep_collect_command(const std::string& folder);
struct CompareArguments {
  std::string scene;
  std::string models = "ribbon,rod,shell-conforming,shell-nonconforming";
  std::string out;  ///< empty: out/<scene>-compare
  std::vector<std::string> set;
  bool quiet = false;
};

int compare_command(const CompareArguments& arguments);

}  // namespace wunderlich::app
