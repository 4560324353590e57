#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

namespace wunderlich::app {

namespace {

using namespace std::chrono_literals;

}  // namespace

// Work that is done in a moment shows nothing.
ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), next_(start_ + (terminal_ ? 300ms : 5000ms)) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) std::cerr << "\r\033[K" << std::flush;
}

void ProgressLine::show(const scene::RunStatus& status) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? 100ms : 10000ms);
  shown_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const std::string line = fmt::format("{:<8} {:3.0f} %  {} iterations  {:.1f} s", status.phase, 100 * status.fraction,
                                       status.iterations, seconds);
  if (terminal_) {
    std::cerr << "\r\033[K" << line << std::flush;
  } else {
    std::cerr << line << "\n";
  }
}

}  // namespace wunderlich::app
