/// `centerline.csv` and `history.csv`.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/base/summary.hpp"

namespace wunderlich::io {

/// One row a node; SI units. Numbers read back bit for bit. Throws std::domain_error on a number that is not finite.
std::string centerline_csv(const std::vector<CenterlineSample>& centerline);

/// One row a recorded step.
std::string history_csv(const std::vector<HistoryRow>& history);

}  // namespace wunderlich::io
