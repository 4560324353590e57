/// A sweep on a cluster that runs Slurm: a job array of shards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wunderlich/sweep/spec.hpp"

namespace wunderlich::sweep {

struct SlurmOptions {
  std::size_t shards = 0;         ///< 0: one for every 500 runs
  int jobs = 1;                   ///< cores of a shard
  std::string walltime;           ///< as sbatch takes it; empty: the partition's default
  std::string partition;          ///< empty: the cluster's default
  bool requeue = true;            ///< a shard whose node fails is done again; it goes on where it was
  std::vector<std::string> more;  ///< further arguments of sbatch, `--mem=2G`
};

/// A text as one word of a POSIX shell.
std::string shell_word(const std::string& text);

/// Never so many that a shard has fewer than 25 runs.
std::size_t shard_count(const SlurmOptions& options, std::size_t runs);

/// The job script: what one task of the array does, and how the array is asked for.
std::string job_script(const SlurmOptions& options, std::size_t runs, const std::string& program,
                       const std::filesystem::path& folder, const std::string& name);

/// Writes the script into the folder and hands it to sbatch; returns the number of the job. Throws InputError with what
/// sbatch says if it refuses, or if there is none.
std::string submit(const SlurmOptions& options, const Sweep& sweep, const std::string& program,
                   const std::filesystem::path& folder);

/// What squeue says of the job that a folder was submitted as, a line a state; empty if it knows of none.
std::string queue_of(const std::filesystem::path& folder);

}  // namespace wunderlich::sweep
