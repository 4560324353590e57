/// `report.html`: one page that holds the whole run.
#pragma once

#include <string>
#include <string_view>

#include "wunderlich/io/run_output.hpp"

namespace wunderlich::io {

/// The template with the run's data in it. Points are rounded to 1/65535 of the bounding box; of long runs only
/// every k-th frame is kept, so that the page stays light.
std::string report_page(const RunOutput& output);

}  // namespace wunderlich::io
