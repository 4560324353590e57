/// `summary.json`: the figures of a run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wunderlich/base/summary.hpp"

namespace wunderlich::io {

/// Indented JSON with the keys of docs/run-folder. Throws std::domain_error, naming the key, if a number is not
/// finite: JSON has no word for it, and no run may end in one.
std::string summary_json(const Summary& summary);

/// The inverse. Throws InputError that begins with `origin`.
Summary parse_summary(std::string_view text, std::string_view origin);

}  // namespace wunderlich::io
