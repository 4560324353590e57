/// A pool of processes: what one of them does wrong harms no other.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace wunderlich::sweep {

struct PoolOptions {
  int workers = 1;
  double timeout = 0;  ///< of one piece of work [s]; 0: none
};

/// What became of one piece of work: its result, or why there is none.
struct Done {
  std::size_t item = 0;
  std::string result;
  std::string failure;  ///< "killed by signal 11 (Segmentation fault)", "took longer than 60 s"
  bool timed_out = false;
};

/// Calls `work(item)` for the items that `next` gives, in child processes, until it gives none (-1). `done` is called
/// here for each, in the order in which they end. `goes_on` is asked now and then, a few times a second at least: when
/// it returns false the rest is dropped and children are killed. Children die with this process. Throws
/// std::runtime_error if no process can be started.
void run_pool(const PoolOptions& options, const std::function<long()>& next,
              const std::function<std::string(std::size_t)>& work, const std::function<void(const Done&)>& done,
              const std::function<bool()>& goes_on);

}  // namespace wunderlich::sweep
