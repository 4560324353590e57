/// What a sweep has found: one table, arrays of fields, a page.
#pragma once

#include <string>
#include <string_view>

#include "wunderlich/sweep/store.hpp"
#include "wunderlich/sweep/sweep.hpp"

namespace wunderlich::sweep {

/// Writes into the sweep's folder `table.csv` (a row a run, in order; columns that depend on the clock come last),
/// FIELD.npy for each field (runs x nodes, NaN where there is none; as many nodes as the longest strip has),
/// `runs.html` with what is kept of each run, and `report.html` from the page's template, whose marks lead there. At
/// any time: runs that are not done have empty cells. Returns how many are there.
std::size_t collect(const std::filesystem::path& folder, const Sweep& sweep, std::string_view page);

}  // namespace wunderlich::sweep
