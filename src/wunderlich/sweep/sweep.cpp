#include "wunderlich/sweep/sweep.hpp"

#include <fmt/format.h>

#include <unordered_set>

#include "wunderlich/base/error.hpp"
#include "wunderlich/base/stopwatch.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/sweep/pool.hpp"
#include "wunderlich/sweep/store.hpp"

namespace wunderlich::sweep {

namespace fs = std::filesystem;

namespace {

std::string log_name(const Shard& shard) {
  return shard.count == 1 ? "all" : fmt::format("shard-{}-of-{}", shard.index + 1, shard.count);
}

/// Need it not be done any more?
bool is_settled(const Found* found, bool retry) {
  if (found == nullptr) return false;
  return !retry || found->status == Status::done || found->status == Status::refused;
}

/// What is left of a shard, by number.
std::vector<std::size_t> open_runs(const Sweep& sweep, const Store& store, const Options& options, Standing& standing) {
  std::vector<std::size_t> open;
  std::unordered_set<std::string> seen;  // equal values make equal runs, which are done once
  for (std::size_t run = options.shard.index; run < run_count(sweep); run += options.shard.count) {
    ++standing.runs;
    const std::string key = key_of(sweep, run);
    const Found* found = store.find(key);
    if (!is_settled(found, options.retry)) {
      if (seen.insert(key).second) {
        open.push_back(run);
      } else {
        ++standing.finished;
      }
      continue;
    }
    ++standing.finished;
    standing.troubled += found->status != Status::done;
  }
  return open;
}

/// Some of them, from the first to the last.
std::vector<std::size_t> spread(const std::vector<std::size_t>& runs, std::size_t most) {
  if (most == 0 || most >= runs.size()) return runs;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < most; ++k) out.push_back(runs[most == 1 ? 0 : k * (runs.size() - 1) / (most - 1)]);
  return out;
}

Record record_of(const Sweep& sweep, const Done& done) {
  if (done.failure.empty()) {
    if (auto record = parse_line(std::string_view(done.result).substr(0, done.result.size() - 1))) return *record;
  }
  Record record;
  record.key = key_of(sweep, done.item);
  record.status = done.timed_out ? Status::timed_out : Status::failed;
  record.reason = done.failure.empty() ? "its result was damaged" : done.failure;
  return record;
}

}  // namespace

double Standing::left() const {
  if (here == 0) return -1;
  return seconds / static_cast<double>(here) * static_cast<double>(runs - finished);
}

bool is_sweep_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kSweepFile, error);
}

namespace {

/// Nothing but what a process leaves that was killed while it prepared a folder, or that is about to: drafts, which
/// begin with a dot, and the scene, which comes before the sweep.
bool is_unused(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.front() != '.' && name != kSceneFile) return false;
  }
  return !error;
}

}  // namespace

void prepare_folder(const fs::path& folder, const Sweep& sweep) {
  std::error_code error;
  if (fs::exists(folder, error) && !is_sweep_folder(folder) &&
      !(fs::is_directory(folder, error) && is_unused(folder)) &&
      !is_sweep_folder(folder)) {  // asked again: another process may just have made it one
    throw InputError(fmt::format("{}: exists and is no folder of a sweep; choose another --out", folder.string()));
  }
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  if (is_sweep_folder(folder)) {
    if (io::read_file(folder / kSweepFile) == sweep.text) return;
    if (is_busy(folder)) {
      throw InputError(
          fmt::format("{}: a process is at work there on another sweep; choose another --out", folder.string()));
    }
  }
  io::write_file(folder / kSceneFile, sweep.scene_text);
  io::write_file(folder / kSweepFile, sweep.text);
}

Sweep sweep_of(const fs::path& folder) {
  if (!is_sweep_folder(folder)) throw InputError(fmt::format("{}: is no folder of a sweep", folder.string()));
  return read_sweep((folder / kSweepFile).string());
}

Standing standing(const fs::path& folder, const Sweep& sweep, const Shard& shard, bool retry) {
  Standing standing;
  open_runs(sweep, Store(folder), {1, shard, retry, 0}, standing);
  return standing;
}

Standing run_sweep(const fs::path& folder, const Sweep& sweep, const Options& options, const Keep& keep,
                   const Observer& observer) {
  Writer writer(folder, log_name(options.shard));
  Standing now;
  const std::vector<std::size_t> open = spread(open_runs(sweep, Store(folder), options, now), options.most);
  const Stopwatch watch;
  std::size_t given = 0;
  bool goes_on = true;
  const auto report = [&] {
    now.seconds = watch.seconds();
    goes_on = goes_on && observer(now);
    return goes_on;
  };
  run_pool(
      {options.jobs, sweep.timeout}, [&] { return given < open.size() ? static_cast<long>(open[given++]) : -1L; },
      [&](std::size_t run) { return line_of(execute(sweep, run, keep)); },
      [&](const Done& done) {
        const Record record = record_of(sweep, done);
        writer.add(record);
        ++now.finished, ++now.here;
        now.troubled += record.status != Status::done;
        report();
      },
      report);
  report();
  return now;
}

}  // namespace wunderlich::sweep
