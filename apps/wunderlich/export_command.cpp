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
#include "wunderlich/picture/colour.hpp"
#include "wunderlich/picture/film.hpp"
#include "wunderlich/report/report_template.hpp"

namespace wunderlich::app {

namespace {

void require_format(bool given, const char* option, io::Format format, std::initializer_list<io::Format> allowed) {
  if (!given || std::find(allowed.begin(), allowed.end(), format) != allowed.end()) return;
  std::string names;
  const io::Format* const last = allowed.end() - 1;
  for (const io::Format& one : allowed) {
    names += (names.empty() ? "" : &one == last ? " and " : ", ") + std::string(io::name(one));
  }
  throw InputError(fmt::format("{}: is for {}, not for {}", option, names, io::name(format)));
}

picture::Style style_of(const ExportArguments& arguments, io::Format format) {
  using enum io::Format;
  require_format(!arguments.size.empty(), "--size", format, {png, mp4});
  require_format(!arguments.view.empty(), "--view", format, {png, mp4});
  require_format(!arguments.colour.empty(), "--colour", format, {png, mp4});
  require_format(arguments.thickness.has_value(), "--thickness", format, {stl, mf3, obj});
  require_format(arguments.frame.has_value(), "--frame", format, {png});
  require_format(arguments.zoom.has_value(), "--zoom", format, {png, mp4});
  require_format(arguments.fps.has_value(), "--fps", format, {mp4});
  picture::Style style;
  if (!arguments.size.empty()) picture::parse_size(arguments.size, style);
  if (!arguments.view.empty()) style.view = picture::parse_direction(arguments.view);
  if (!arguments.colour.empty()) style.colour = picture::parse_colour(arguments.colour);
  style.zoom = arguments.zoom.value_or(style.zoom);
  if (!(style.zoom >= 1 && style.zoom <= picture::largest_zoom)) {
    throw InputError(
        fmt::format("--zoom: {:g} is not allowed; must be from 1 to {:g}", style.zoom, picture::largest_zoom));
  }
  style.fps = arguments.fps.value_or(style.fps);
  if (!(style.fps >= picture::smallest_fps && style.fps <= picture::largest_fps)) {
    throw InputError(fmt::format("--fps: {:g} is not allowed; must be from {:g} to {:g}", style.fps,
                                 picture::smallest_fps, picture::largest_fps));
  }
  if (format == mp4) picture::require_film(style);
  return style;
}

std::size_t frame_of(long frame, std::size_t frames) {
  if (frame >= 0 && static_cast<std::size_t>(frame) < frames) return static_cast<std::size_t>(frame);
  throw InputError(fmt::format("--frame: {} is not allowed; the run has the frames 0 to {}", frame, frames - 1));
}

/// What the colours mean.
void say_range(const io::RunOutput& output, io::Format format, const picture::Style& style) {
  if (style.colour == picture::Colour::plain) return;
  std::vector<const Frame*> frames;
  for (const Frame& frame : output.frames) frames.push_back(&frame);
  if (format == io::Format::png) frames = {frames[style.frame.value_or(frames.size() - 1)]};
  const double range = picture::range_of(frames, style.colour);
  const bool energy = style.colour == picture::Colour::energy;
  std::cout << fmt::format("{}: {} {:.4g} ... red {:.4g}{}\n", picture::name(style.colour), energy ? "pale" : "blue",
                           energy ? 0 : -range, range,
                           energy                                 ? " D/2 per m^2, drawn by its root"
                           : style.colour == picture::Colour::eta ? ""
                                                                  : " 1/m");
}

}  // namespace

int export_command(const ExportArguments& arguments) {
  const io::Format format = io::parse_format(arguments.format);
  const std::filesystem::path folder = arguments.run;
  picture::Style style = style_of(arguments, format);
  const StoredRun run = load_run(folder);
  if (arguments.frame) style.frame = frame_of(*arguments.frame, run.progress.records.size());
  const std::filesystem::path summary = folder / io::summary_file;
  io::RunOutput output =
      output_of(run, io::parse_summary(io::read_file(summary), summary.string()), report::report_template(), style);
  output.thickness = arguments.thickness;
  if (!arguments.out.empty()) {
    io::write_format(arguments.out, format, output);
    std::cout << arguments.out << "\n";
    say_range(output, format, style);
    return done;
  }
  for (const auto& [name, bytes] : io::render(format, output)) {
    const std::filesystem::path file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    io::write_file(file, bytes);
    // One line a format, not one a frame.
    if (file.parent_path() == folder) std::cout << file.string() << "\n";
  }
  say_range(output, format, style);
  return done;
}

}  // namespace wunderlich::app
