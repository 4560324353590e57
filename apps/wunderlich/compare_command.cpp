#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "wunderlich/io/comparison.hpp"
#include "wunderlich/io/output_folder.hpp"
#include "wunderlich/report/report_template.hpp"
#include "wunderlich/scene/compare.hpp"
#include "wunderlich/scene/read.hpp"

namespace wunderlich::app {

namespace {

void print_table(const Comparison& comparison) {
  std::cout << fmt::format("{:<20} {:<18} {:>9} {:>11} {:>12} {:>10} {:>10} {:>10} {:>11}\n", "model", "resolution",
                           "unknowns", "constraints", "V l/(D w)", "area", "diagonal", "rim", "us a step");
  for (const ModelResult& m : comparison.models) {
    std::cout << fmt::format("{:<20} {:<18} {:>9} {:>11}", m.model, m.resolution, m.unknowns, m.constraints);
    if (m.steps > 0) {
      std::cout << fmt::format(" {:>12.6g} {:>10.2e} {:>10.2e} {:>10.2e} {:>11.4g}", m.energy.normalized,
                               m.isometry.area, m.isometry.diagonal, m.isometry.rim, m.step_us);
    }
    std::cout << "\n";
  }
}

/// The worst of the models decides.
int exit_code(const Comparison& comparison) {
  int code = done;
  for (const ModelResult& m : comparison.models) {
    for (const std::string& note : m.notes) std::cerr << fmt::format("note: {}: {}\n", m.model, note);
    if (m.converged) continue;
    std::cerr << fmt::format("{}: did not converge: {}; its last good state is written\n", m.model, m.failure);
    code = not_converged;
  }
  return code;
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  const std::vector<scene::Model> models = scene::parse_models(arguments.models);
  const scene::Scene scene = scene::read_scene(arguments.scene, arguments.set);
  scene::check_comparable(scene);
  scene::check_start(scene);
  const std::filesystem::path folder = arguments.out.empty() ? std::filesystem::path("out") / (scene.name + "-compare")
                                                             : std::filesystem::path(arguments.out);
  io::require_replaceable(folder, io::is_comparison);

  catch_interrupts();
  Comparison comparison;
  {
    ProgressLine progress(arguments.quiet);
    comparison = scene::compare(scene, models, [&](const scene::RunStatus& status) {
      progress.show(status);
      return !interrupt_requested();
    });
  }
  const bool cut = comparison.models.back().failure == scene::kInterrupted;  // the one that was under way
  if (cut) {
    comparison.models.pop_back();
    comparison.bodies.pop_back();
    std::cerr << fmt::format("{}: interrupted; {} of {} models are done\n", scene.name, comparison.models.size(),
                             models.size());
    if (comparison.models.empty()) return interrupted;
  }
  io::write_comparison(folder, comparison, report::comparison_template());
  if (!arguments.quiet) {
    print_table(comparison);
    std::cout << folder.string() << "\n";
  }
  return cut ? interrupted : exit_code(comparison);
}

}  // namespace wunderlich::app
