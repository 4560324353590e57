/// Runs a sweep, or a shard of it, on this machine; goes on where an earlier call was cut off.
#pragma once

#include <filesystem>

#include "wunderlich/sweep/execute.hpp"

namespace wunderlich::sweep {

/// The sweep with its scene inside, and the scene alone. Names that nobody gives their own files.
inline constexpr const char* kSweepFile = "resolved-sweep.yaml";
inline constexpr const char* kSceneFile = "resolved-scene.yaml";

/// Runs i with i mod count = index; (0, 1) is all.
struct Shard {
  std::size_t index = 0;
  std::size_t count = 1;
};

struct Options {
  int jobs = 1;
  Shard shard;
  bool retry = false;    ///< do again what failed, timed out or did not converge
  std::size_t most = 0;  ///< runs, spread evenly over what is left; 0: all of it
};

struct Standing {
  std::size_t runs = 0;      ///< of the shard
  std::size_t finished = 0;  ///< those that need not be done any more
  std::size_t troubled = 0;  ///< of them, all that did not converge, whatever the reason
  std::size_t here = 0;      ///< finished by this call
  double seconds = 0;        ///< that this call has taken
  /// Time that the rest will take at this rate [s]; negative while unknown.
  double left() const;
};

/// Called after every run and a few times a second; returns false to stop.
using Observer = std::function<bool(const Standing&)>;

/// Prepares the folder: writes the sweep there. Several processes may do so at once. Throws InputError if the folder
/// holds something else, or another sweep on which a process is at work.
void prepare_folder(const std::filesystem::path& folder, const Sweep& sweep);

/// Whether it is a sweep's folder.
bool is_sweep_folder(const std::filesystem::path& folder);

/// The sweep that a folder is of. Throws InputError if it is none.
Sweep sweep_of(const std::filesystem::path& folder);

/// How a shard stands, from what is on disk.
Standing standing(const std::filesystem::path& folder, const Sweep& sweep, const Shard& shard, bool retry);

/// Does what is left of a shard; returns how it stands then. Throws InputError if another process does the same shard.
Standing run_sweep(const std::filesystem::path& folder, const Sweep& sweep, const Options& options, const Keep& keep,
                   const Observer& observer);

}  // namespace wunderlich::sweep
