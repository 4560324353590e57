/// The file formats a run can be written in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wunderlich::io {

enum class Format {
  vtp,   ///< `ribbon.pvd` and `frames/*.vtp`, with obstacles `solids.pvd` and `solids/*.vtp`: ParaView
  glb,   ///< `ribbon.glb`: any 3D viewer; short clips in Blender
  pc2,   ///< `ribbon.pc2` and `ribbon_rest.obj`: long clips in Blender
  obj,   ///< `ribbon.obj`: the final surface, or a body where a thickness is asked for
  stl,   ///< `ribbon.stl`: the final surface as a body to print
  mf3,   ///< `ribbon.3mf`: the same for newer slicers
  svg,   ///< `pattern.svg`: the strip unrolled flat
  html,  ///< `report.html`
  png,   ///< `picture.png`: a still
  mp4,   ///< `film.mp4`, by ffmpeg
};

/// Name as on the command line.
std::string_view name(Format format);

/// All of them: "vtp, glb, ..."
std::string format_names();

/// One name; `svg-pattern` means svg. Throws InputError with the names that are allowed.
Format parse_format(std::string_view text);

/// Comma-separated names in any order, or `none`. Throws InputError.
std::vector<Format> parse_formats(std::string_view list);

}  // namespace wunderlich::io
