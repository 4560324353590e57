/// Everything a finished, failed or interrupted run has to say.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/base/summary.hpp"
#include "wunderlich/io/checkpoint.hpp"

namespace wunderlich::io {

/// A line of the report's table of parameters, as text: {"ribbon.width", "0.4 m"}.
using Parameter = std::pair<std::string, std::string>;

struct RunOutput {
  std::string title;  ///< one line about the scene
  Summary summary;
  std::vector<HistoryRow> history;
  std::vector<Frame> frames;          ///< at least one; the last is the final state
  std::vector<Body> bodies;           ///< obstacles
  std::vector<FlatPattern> patterns;  ///< of the final state, one a strip; at least one
  std::optional<double> thickness;    ///< of bodies to print [m]; without it that of each strip's material
  std::vector<Parameter> parameters;
  std::string scene_text;  ///< the scene file after all overrides
  Checkpoint checkpoint;
  std::string_view report_template;                       ///< the page without data; needed for Format::html only
  std::function<std::string(const RunOutput&)> png, mp4;  ///< draw a still or a film; needed for these formats only
};

}  // namespace wunderlich::io
