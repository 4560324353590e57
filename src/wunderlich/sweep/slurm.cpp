#include "wunderlich/sweep/slurm.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/sweep/sweep.hpp"

namespace wunderlich::sweep {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kRunsOfAShard = 500, kLeastRuns = 25;
constexpr const char* kJobFile = "slurm/job";

struct Answer {
  int code = -1;
  std::string text;  ///< standard output and error
};

/// What sbatch takes for a name without quotes.
std::string plain(std::string text) {
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '-';
  }
  return text;
}

/// sbatch fills in what follows a percent sign.
std::string doubled(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == '%' ? "%%" : std::string(1, c);
  return out;
}

Answer call(const std::string& command) {
  Answer answer;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> block;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), pipe))
    answer.text.append(block.data(), count);
  const int status = ::pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

}  // namespace

std::string shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::size_t shard_count(const SlurmOptions& options, std::size_t runs) {
  const std::size_t wanted = options.shards > 0 ? options.shards : (runs + kRunsOfAShard - 1) / kRunsOfAShard;
  return std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(1, runs / kLeastRuns));
}

std::string job_script(const SlurmOptions& options, std::size_t runs, const std::string& program,
                       const fs::path& folder, const std::string& name) {
  const std::size_t shards = shard_count(options, runs);
  std::string out = "#!/bin/sh\n# One task of the array is one shard of the sweep; it goes on where it was cut off.\n";
  out += fmt::format("#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task={}\n",
                     plain("wunderlich-" + name), shards, options.jobs);
  out += fmt::format("#SBATCH --output=\"{}/slurm/%A_%a.out\"\n", doubled(folder.string()));
  out += options.requeue ? "#SBATCH --requeue\n" : "#SBATCH --no-requeue\n";
  if (!options.walltime.empty()) out += fmt::format("#SBATCH --time={}\n", options.walltime);
  if (!options.partition.empty()) out += fmt::format("#SBATCH --partition={}\n", options.partition);
  for (const std::string& more : options.more) out += fmt::format("#SBATCH {}\n", more);
  out += fmt::format("exec {} sweep {} --out {} --shard \"$SLURM_ARRAY_TASK_ID/{}\" --jobs {} --quiet\n",
                     shell_word(program), shell_word((folder / kSweepFile).string()), shell_word(folder.string()),
                     shards, options.jobs);
  return out;
}

std::string submit(const SlurmOptions& options, const Sweep& sweep, const std::string& program,
                   const fs::path& folder) {
  const fs::path where = fs::absolute(folder);
  std::error_code error;
  fs::create_directories(where / "slurm", error);
  if (error) throw InputError(fmt::format("{}: cannot be created: {}", (where / "slurm").string(), error.message()));
  const fs::path script = where / "slurm" / "job.sh";
  io::write_file(script, job_script(options, run_count(sweep), program, where, sweep.name));
  const Answer answer = call("sbatch --parsable " + shell_word(script.string()));
  if (answer.code == 127) {
    throw InputError(
        fmt::format("--engine slurm: there is no `sbatch` here; {} is what it would be given", script.string()));
  }
  if (answer.code != 0) throw InputError("--engine slurm: sbatch refused: " + answer.text);
  const std::string job = answer.text.substr(0, answer.text.find_first_of(";\n"));
  io::write_file(where / kJobFile, job + "\n");
  return job;
}

std::string queue_of(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / kJobFile, error)) return "";
  std::string job = io::read_file(folder / kJobFile, 100);
  job = job.substr(0, job.find('\n'));
  const Answer answer = call(fmt::format("squeue --noheader --array --format=%T --jobs={}", shell_word(job)));
  if (answer.code != 0) return "";
  std::map<std::string, int> states;
  std::istringstream lines(answer.text);
  for (std::string line; std::getline(lines, line);) ++states[line];
  std::string out;
  for (const auto& [state, count] : states) out += fmt::format("{} {}\n", count, state);
  return out;
}

}  // namespace wunderlich::sweep
