#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <thread>

#include "commands.hpp"
#include "interrupt.hpp"
#include "stored_run.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/report/report_template.hpp"
#include "wunderlich/sweep/slurm.hpp"
#include "wunderlich/sweep/table.hpp"

namespace wunderlich::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTried = 3;  // runs, or one a process, from which the time of all is guessed

std::string duration(double seconds) {
  if (seconds < 0) return "unknown";
  if (seconds < 90) return fmt::format("{:.1f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// One line that is rewritten on a terminal, sparse lines elsewhere.
class SweepLine {
 public:
  explicit SweepLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}
  SweepLine(const SweepLine&) = delete;
  SweepLine& operator=(const SweepLine&) = delete;
  ~SweepLine() {
    if (shown_ && terminal_) std::cerr << "\r\033[K" << std::flush;
  }

  void show(const sweep::Standing& now) {
    if (quiet_ || now.seconds < next_) return;
    next_ = now.seconds + (terminal_ ? 0.2 : 10);
    if (!terminal_ && !shown_) {
      shown_ = true;  // the first line would say nothing yet
      return;
    }
    shown_ = true;
    const std::string line = fmt::format("{} of {} runs, {} without a result, {} left", now.finished, now.runs,
                                         now.troubled, duration(now.left()));
    std::cerr << (terminal_ ? "\r\033[K" : "") << line << (terminal_ ? "" : "\n") << std::flush;
  }

 private:
  bool quiet_, terminal_, shown_ = false;
  double next_ = 0.3;
};

sweep::Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  unsigned long index = 0, count = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%lu/%lu%c", &index, &count, &end) != 2 || index < 1 || index > count ||
      count > 1'000'000) {
    throw InputError(fmt::format("--shard {}: must be I/N with 1 <= I <= N, such as 3/8", text));
  }
  return {index - 1, count};
}

int jobs_of(const SweepArguments& arguments) {
  if (arguments.jobs < 0 || arguments.jobs > 1024) throw InputError("--jobs: must be from 1 to 1024");
  if (arguments.jobs > 0) return arguments.jobs;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Writes the run folder that `keep` asks for.
sweep::Keep keeper(const sweep::Sweep& sweep, const fs::path& folder) {
  std::vector<io::Format> formats;
  formats.reserve(sweep.keep.size());
  for (const std::string& word : sweep.keep) formats.push_back(io::parse_format(word));
  require_tools(formats);
  return [formats, folder](const scene::Scene& scene, scene::RunResult& result, const std::string& key) {
    const StoredRun run{scene, std::move(result.progress), result.outcome};
    io::write_run_folder(folder / "runs" / key, output_of(run, result.summary, report::report_template()), formats);
  };
}

int submit_to_slurm(const SweepArguments& arguments, const sweep::Sweep& sweep, const fs::path& folder) {
  sweep::SlurmOptions options;
  options.shards = arguments.shards;
  options.jobs = arguments.jobs > 0 ? arguments.jobs : 1;
  options.walltime = arguments.walltime;
  options.partition = arguments.partition;
  options.requeue = !arguments.no_requeue;
  options.more = arguments.sbatch;
  const std::string job = sweep::submit(options, sweep, fs::read_symlink("/proc/self/exe").string(), folder);
  if (!arguments.quiet) {
    std::cout << fmt::format("{}: {} runs in {} shards, job {}\n", sweep.name, run_count(sweep),
                             shard_count(options, run_count(sweep)), job)
              << fmt::format("  wunderlich sweep status {0}\n  wunderlich sweep collect {0}\n", folder.string());
  }
  return done;
}

void report(const sweep::Sweep& sweep, const sweep::Standing& now, const fs::path& folder) {
  std::cout << fmt::format("{}: {} of {} runs, {} of them without a result\n{}\n", sweep.name, now.finished, now.runs,
                           now.troubled, folder.string());
}

}  // namespace

int sweep_command(const SweepArguments& arguments) {
  const sweep::Sweep sweep = sweep::read_sweep(arguments.sweep);
  const fs::path folder = arguments.out.empty() ? fs::path("out") / sweep.name : fs::path(arguments.out);
  sweep::Options options{jobs_of(arguments), shard_of(arguments.shard), arguments.retry, 0};
  if (arguments.engine != "local" && arguments.engine != "slurm") {
    throw InputError(fmt::format("--engine {}: must be local or slurm", arguments.engine));
  }
  prepare_folder(folder, sweep);
  if (arguments.engine == "slurm") return submit_to_slurm(arguments, sweep, folder);

  catch_interrupts();
  const sweep::Keep keep = keeper(sweep, folder);
  sweep::Standing now = standing(folder, sweep, options.shard, options.retry);
  const auto go = [&](std::size_t most) {
    SweepLine line(arguments.quiet);
    options.most = most;
    now = run_sweep(folder, sweep, options, keep, [&](const sweep::Standing& s) {
      line.show(s);
      return !interrupt_requested();
    });
  };
  if (!arguments.quiet) {
    std::cout << fmt::format("{}: {} runs, {} of them done already\n", sweep.name, now.runs, now.finished)
              << std::flush;
    const std::size_t tried = std::max(kTried, static_cast<std::size_t>(options.jobs));
    if (now.runs - now.finished > tried) {
      go(tried);
      std::cout << fmt::format("about {} with {} processes, as {} runs took\n", duration(now.left()), options.jobs,
                               tried)
                << std::flush;
    }
  }
  if (!interrupt_requested()) go(0);
  if (interrupt_requested()) {
    std::cerr << fmt::format("{}: interrupted after {} of {} runs; the same command goes on\n", sweep.name,
                             now.finished, now.runs);
    return interrupted;
  }
  if (options.shard.count == 1) collect(folder, sweep, report::sweep_template());
  if (!arguments.quiet) report(sweep, now, folder);
  return done;
}

int sweep_status_command(const std::string& folder) {
  const sweep::Sweep sweep = sweep::sweep_of(folder);
  report(sweep, standing(folder, sweep, {}, false), folder);
  const std::string queue = sweep::queue_of(folder);
  if (!queue.empty()) std::cout << "in the queue:\n" << queue;
  return done;
}

int sweep_collect_command(const std::string& folder) {
  const sweep::Sweep sweep = sweep::sweep_of(folder);
  const std::size_t there = collect(folder, sweep, report::sweep_template());
  std::cout << fmt::format("{}: {} of {} runs\n{}\n", sweep.name, there, run_count(sweep),
                           (fs::path(folder) / "table.csv").string());
  return done;
}

}  // namespace wunderlich::app
