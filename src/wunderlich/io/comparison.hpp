/// A comparison of models as a table, as JSON and as a page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wunderlich/base/comparison.hpp"

namespace wunderlich::io {

/// One row a model. Throws std::domain_error if a number is not finite.
std::string comparison_csv(const Comparison& comparison);

/// The same with what does not fit a table. Throws std::domain_error if a number is not finite.
std::string comparison_json(const Comparison& comparison);

/// One self-contained page: the shapes side by side, playing together, and the table. `page` is the template.
std::string comparison_page(const Comparison& comparison, std::string_view page);

/// Is it a folder that `write_comparison` wrote?
bool is_comparison(const std::filesystem::path& folder);

/// comparison.json, comparison.csv, report.html, and of each model the final surface, MODEL.obj; whole or not at all.
/// Throws as `write_whole_folder` and the above.
void write_comparison(const std::filesystem::path& folder, const Comparison& comparison, std::string_view page);

}  // namespace wunderlich::io
