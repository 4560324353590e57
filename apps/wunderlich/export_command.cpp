#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "stored_run.hpp"
#include "wunderlich/base/error.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/run_folder.hpp"
#include "wunderlich/io/summary_json.hpp"
#include "wunderlich/report/report_template.hpp"

namespace wunderlich::app {

namespace {

void check_thickness(double thickness, io::Format format, const std::vector<FlatPattern>& strips) {
  if (format != io::Format::stl && format != io::Format::mf3 && format != io::Format::obj) {
    throw InputError(fmt::format("--thickness: is for stl, 3mf and obj, not for {}", io::name(format)));
  }
  double width = strips.front().width;
  for (const FlatPattern& strip : strips) width = std::min(width, strip.width);
  if (!(thickness > 0 && thickness <= width)) {
    throw InputError(fmt::format("--thickness: {:g} is not allowed; must be above 0 and at most the width, {:g} m",
                                 thickness, width));
  }
}

}  // namespace

int export_command(const ExportArguments& arguments) {
  const io::Format format = io::parse_format(arguments.format);
  const std::filesystem::path folder = arguments.run;
  const StoredRun run = load_run(folder);
  const std::filesystem::path summary = folder / io::summary_file;
  io::RunOutput output =
      output_of(run, io::parse_summary(io::read_file(summary), summary.string()), report::report_template());
  if (arguments.thickness) check_thickness(*arguments.thickness, format, output.patterns);
  output.thickness = arguments.thickness;
  if (!arguments.out.empty()) {
    io::write_format(arguments.out, format, output);
    std::cout << arguments.out << "\n";
    return done;
  }
  for (const auto& [name, bytes] : io::render(format, output)) {
    const std::filesystem::path file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    io::write_file(file, bytes);
    // One line a format, not one a frame.
    if (file.parent_path() == folder) std::cout << file.string() << "\n";
  }
  return done;
}

}  // namespace wunderlich::app
