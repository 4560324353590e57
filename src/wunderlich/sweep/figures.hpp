/// Figures of a run by name.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace wunderlich::sweep {

/// A figure that a run does not have.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// `energy.normalized`, `ends.1.force.0`, `kappa_zeros.count` of the summary, `shape.max_kappa`; NaN where this run has
/// none. Truth is 1.
double figure(const nlohmann::ordered_json& body, const std::string& path);

/// Whether any run can have such a figure.
bool is_figure(const std::string& path);

/// The figures that have no numbers in their names, for messages.
std::vector<std::string> figure_names();

}  // namespace wunderlich::sweep
