/// What is kept of one run of a sweep: a line of a log.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wunderlich::sweep {

/// How a run ended.
enum class Status {
  done,           ///< converged
  not_converged,  ///< the solver says so
  refused,        ///< the scene's values contradict each other
  failed,         ///< the process died, or something else went wrong
  timed_out,
};
const char* status_name(Status status);

struct Record {
  std::string key;
  Status status = Status::failed;
  std::string reason;  ///< why it is not done
  double seconds = 0;  ///< from reading the scene to the record; 0 where the process did not get there
  std::string body;    ///< JSON: `summary`, `shape`, `fields`; empty where there is nothing
};

/// One line with a checksum before it, so that a torn or damaged one is known, and a line feed at its end.
std::string line_of(const Record& record);

/// The inverse, without the line feed; nothing if the line is damaged.
std::optional<Record> parse_line(std::string_view line);

}  // namespace wunderlich::sweep
