/// The report page without its data, built from web/report.
#pragma once

#include <string_view>

namespace wunderlich::report {

/// HTML with one place for the data of a run, see `wunderlich::io::report_page`.
std::string_view report_template();

/// The same for a comparison of models, see `wunderlich::io::comparison_page`.
std::string_view comparison_template();

/// The same for a sweep, see `wunderlich::sweep::collect`.
std::string_view sweep_template();

}  // namespace wunderlich::report
