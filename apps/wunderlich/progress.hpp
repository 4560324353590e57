/// Progress of long work on standard error: one line that is rewritten on a terminal, sparse lines elsewhere.
#pragma once

#include <chrono>

#include "wunderlich/scene/run.hpp"

namespace wunderlich::app {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();  ///< leaves a clean line

  void show(const scene::RunStatus& status);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace wunderlich::app
