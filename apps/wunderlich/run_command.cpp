#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "stored_run.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/report/report_template.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/run.hpp"

namespace wunderlich::app {

namespace {

/// Where a run starts: a scene, and what was done of it before.
struct Start {
  scene::Scene scene;
  scene::Progress progress{};
  scene::Outcome outcome = scene::Outcome::interrupted;
  bool resumed = false;
};

std::filesystem::path default_folder(const std::string& scene_name) {
  return std::filesystem::path("out") / std::filesystem::path(scene_name).stem();
}

/// Overrides may be repeated on resuming, but a different scene would not be the run that was interrupted.
void require_same_scene(const StoredRun& stored, const std::string& name, const std::vector<std::string>& set) {
  if (scene::read_scene(name).written != stored.scene.written) {
    throw InputError(
        fmt::format("{}: has changed since the run that --resume goes on with; start anew without --resume", name));
  }
  for (const std::string& assignment : set) {
    if (scene::read_scene_text(stored.scene.resolved, "checkpoint", {assignment}).resolved == stored.scene.resolved)
      continue;
    throw InputError(
        fmt::format("--set {}: changes the scene of the run that --resume goes on with; leave it out, or start "
                    "anew without --resume",
                    assignment));
  }
}

Start resumed_start(const RunArguments& arguments, const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) throw InputError(folder.string() + ": there is no run to resume");
  StoredRun stored = load_run(folder);
  const std::string name = std::filesystem::path(arguments.scene).stem().string();
  if (name != stored.scene.name) {
    throw InputError(
        fmt::format("{}: is a run of the scene `{}`, not of `{}`", folder.string(), stored.scene.name, name));
  }
  require_same_scene(stored, arguments.scene, arguments.set);
  return {std::move(stored.scene), std::move(stored.progress), stored.outcome, true};
}

std::vector<io::Format> formats_of(const RunArguments& arguments, const scene::Scene& scene) {
  if (arguments.formats) return io::parse_formats(*arguments.formats);
  std::vector<io::Format> formats;
  for (const std::string& word : scene.output.formats) formats.push_back(io::parse_format(word));
  return formats;
}

int exit_code(scene::Outcome outcome) {
  switch (outcome) {
    case scene::Outcome::converged:
      return done;
    case scene::Outcome::not_converged:
      return not_converged;
    case scene::Outcome::interrupted:
      break;
  }
  return interrupted;
}

void report(const StoredRun& run, const Summary& summary, const std::filesystem::path& folder) {
  for (const std::string& warning : summary.warnings) std::cerr << "warning: " << warning << "\n";
  const std::string figures = fmt::format("{} steps, {:.1f} ms, V l/(D w) = {:.6g}", summary.steps,
                                          1e3 * summary.timing.wall_seconds, summary.energy.normalized);
  switch (run.outcome) {
    case scene::Outcome::converged:
      std::cout << fmt::format("{}: converged: {}\n", run.scene.name, figures);
      break;
    case scene::Outcome::not_converged:
      std::cerr << fmt::format("{}: did not converge: {}; the last good state is written\n", run.scene.name,
                               summary.failure);
      break;
    case scene::Outcome::interrupted:
      std::cerr << fmt::format("{}: interrupted after {} steps; --resume goes on\n", run.scene.name, summary.steps);
      break;
  }
  std::cout << folder.string() << "\n";
}

/// --resume of a run that has nothing left to do.
int report_finished(const Start& start, const std::filesystem::path& folder, bool quiet) {
  const bool converged = start.outcome == scene::Outcome::converged;
  if (!quiet) {
    std::cerr << fmt::format("{}: {}; there is nothing to resume\n", folder.string(),
                             converged ? "this run is done" : "this run did not converge");
  }
  return exit_code(start.outcome);
}

}  // namespace

int run_command(const RunArguments& arguments) {
  const std::filesystem::path folder =
      arguments.out.empty() ? default_folder(arguments.scene) : std::filesystem::path(arguments.out);
  const Start start =
      arguments.resume ? resumed_start(arguments, folder) : Start{scene::read_scene(arguments.scene, arguments.set)};
  if (!arguments.resume) scene::check_start(start.scene);
  const std::vector<io::Format> formats = formats_of(arguments, start.scene);
  if (start.outcome != scene::Outcome::interrupted) return report_finished(start, folder, arguments.quiet);
  io::require_writable(folder);
  require_tools(formats);

  catch_interrupts();
  scene::RunResult result;
  {
    ProgressLine progress(arguments.quiet);
    const scene::Observer observer = [&](const scene::RunStatus& status) {
      progress.show(status);
      return !interrupt_requested();
    };
    result = scene::run(start.scene, observer, start.resumed ? &start.progress : nullptr);
  }

  const StoredRun run{start.scene, std::move(result.progress), result.outcome};
  const io::RunOutput output = output_of(run, result.summary, report::report_template());
  try {
    io::write_run_folder(folder, output, formats);
  } catch (const InputError&) {  // an encoder that fails must not cost the run
    io::write_run_folder(folder, output, {});
    throw;
  }
  if (!arguments.quiet) report(run, result.summary, folder);
  return exit_code(run.outcome);
}

}  // namespace wunderlich::app
