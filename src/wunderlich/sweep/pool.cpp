#include "wunderlich/sweep/pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <deque>
#include <vector>

#include "wunderlich/base/error.hpp"

namespace wunderlich::sweep {

namespace {

using Clock = std::chrono::steady_clock;

/// All of it, or false at the end of the stream.
bool read_all(int file, void* to, std::size_t size) {
  auto* at = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t got = ::read(file, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_all(int file, const void* from, std::size_t size) {
  const auto* at = static_cast<const char*>(from);
  while (size > 0) {
    const ssize_t put = ::send(file, at, size, MSG_NOSIGNAL);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    at += put;
    size -= static_cast<std::size_t>(put);
  }
  return true;
}

[[noreturn]] void serve(int channel, pid_t parent, const std::function<std::string(std::size_t)>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it was gone before that took effect
  ::signal(SIGINT, SIG_IGN);              // Ctrl-C reaches the whole group; the parent decides
  // Locks and channels of others are not this process's to hold.
  ::close_range(3, static_cast<unsigned>(channel) - 1, 0);
  ::close_range(static_cast<unsigned>(channel) + 1, ~0u, 0);
  try {
    for (std::uint64_t item = 0; read_all(channel, &item, sizeof item);) {
      const std::string result = work(static_cast<std::size_t>(item));
      const std::uint64_t size = result.size();
      if (!write_all(channel, &size, sizeof size) || !write_all(channel, result.data(), result.size())) break;
    }
  } catch (...) {
    ::_exit(1);  // never back into what was the parent's
  }
  ::_exit(0);  // no destructors: what they would flush belongs to the parent
}

/// A process and the items it has been given: one under way, and one to go on with at once when that is done.
struct Worker {
  pid_t process = -1;
  int channel = -1;
  std::deque<std::size_t> items;
  Clock::time_point deadline;  ///< of the first
  bool busy() const { return !items.empty(); }
};

constexpr double kShort = 0.1;  // s; of longer runs none waits behind another

Worker start_worker(const std::function<std::string(std::size_t)>& work) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
    throw InputError(fmt::format("processes cannot be started: {}", std::strerror(errno)));
  const pid_t parent = ::getpid(), process = ::fork();
  if (process < 0) throw InputError(fmt::format("processes cannot be started: {}", std::strerror(errno)));
  if (process == 0) {
    serve(ends[1], parent, work);
  }
  ::close(ends[1]);
  return {process, ends[0], {}, {}};
}

/// Ends a worker; says how it ended by itself, if it did.
std::string end(Worker& worker, bool kill) {
  if (worker.process < 0) return "";
  if (kill) ::kill(worker.process, SIGKILL);
  ::close(worker.channel);
  int status = 0;
  ::waitpid(worker.process, &status, 0);
  worker.process = -1, worker.channel = -1;
  if (WIFSIGNALED(status)) {
    return fmt::format("killed by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  }
  return fmt::format("ended with code {}", WEXITSTATUS(status));
}

class Pool {
 public:
  Pool(const PoolOptions& options, const std::function<std::string(std::size_t)>& work)
      : options_(options), work_(work), workers_(static_cast<std::size_t>(std::max(1, options.workers))) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    for (Worker& worker : workers_) end(worker, worker.busy());
  }

  void go(const std::function<long()>& next, const std::function<void(const Done&)>& done,
          const std::function<bool()>& goes_on) {
    for (Worker& worker : workers_) give(worker, next);
    while (busy() && goes_on()) {
      wait();
      for (std::size_t i = 0; i < workers_.size(); ++i) {
        Done result;
        if (!take(workers_[i], ready_[i], result)) continue;
        give(workers_[i], next);
        done(result);
      }
    }
  }

 private:
  bool busy() const {
    return std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return w.busy(); });
  }

  /// What a worker left undone goes before what is new.
  long next_item(const std::function<long()>& next) {
    if (left_.empty()) return next();
    const std::size_t item = left_.back();
    left_.pop_back();
    return static_cast<long>(item);
  }

  void give(Worker& worker, const std::function<long()>& next) {
    while (worker.items.size() < given()) {
      const long item = next_item(next);
      if (item < 0) return;
      if (worker.process < 0) worker = start_worker(work_);
      if (!worker.busy()) start_clock(worker);
      worker.items.push_back(static_cast<std::size_t>(item));
      const auto number = static_cast<std::uint64_t>(item);
      write_all(worker.channel, &number, sizeof number);  // if it is gone, reading will show it
    }
  }

  /// Two, while runs are short: the second hides the time that the answer takes.
  std::size_t given() const {
    const double busy =
        std::chrono::duration<double>(Clock::now() - start_).count() * static_cast<double>(workers_.size());
    return taken_ > 0 && busy < kShort * static_cast<double>(taken_) ? 2 : 1;
  }

  void start_clock(Worker& worker) const {
    const double seconds = options_.timeout > 0 ? options_.timeout : 1e9;
    worker.deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  /// Until a worker answers, or one is late.
  void wait() {
    std::vector<pollfd> files;
    std::vector<std::size_t> whose;
    Clock::time_point first = Clock::now() + std::chrono::milliseconds(200);
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (!workers_[i].busy()) continue;
      files.push_back({workers_[i].channel, POLLIN, 0});
      whose.push_back(i);
      first = std::min(first, workers_[i].deadline);
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(first - Clock::now()).count();
    const int answers = ::poll(files.data(), files.size(), static_cast<int>(std::max<long>(0, left + 1)));
    if (answers < 0 && errno != EINTR)
      throw InputError(fmt::format("processes cannot be waited for: {}; fewer --jobs may help", std::strerror(errno)));
    ready_.assign(workers_.size(), false);
    for (std::size_t k = 0; k < files.size(); ++k) ready_[whose[k]] = answers > 0 && files[k].revents != 0;
  }

  bool take(Worker& worker, bool ready, Done& result) {
    if (!worker.busy() || (!ready && Clock::now() < worker.deadline)) return false;
    result.item = worker.items.front();
    worker.items.pop_front();
    if (!ready) {
      end(worker, true);
      result.timed_out = true;
      result.failure = fmt::format("took longer than {:g} s", options_.timeout);
    } else if (!read_result(worker.channel, result.result)) {
      result.failure = end(worker, true);
    } else {
      ++taken_;
      start_clock(worker);
      return true;
    }
    left_.insert(left_.end(), worker.items.begin(), worker.items.end());  // never begun
    worker.items.clear();
    return true;
  }

  static bool read_result(int channel, std::string& result) {
    std::uint64_t size = 0;
    if (!read_all(channel, &size, sizeof size)) return false;
    result.resize(size);
    return read_all(channel, result.data(), size);
  }

  PoolOptions options_;
  const std::function<std::string(std::size_t)>& work_;
  std::vector<Worker> workers_;
  std::vector<bool> ready_;
  Clock::time_point start_ = Clock::now();
  std::size_t taken_ = 0;          ///< results so far
  std::vector<std::size_t> left_;  ///< given to workers that died before they came to it
};

}  // namespace

void run_pool(const PoolOptions& options, const std::function<long()>& next,
              const std::function<std::string(std::size_t)>& work, const std::function<void(const Done&)>& done,
              const std::function<bool()>& goes_on) {
  Pool(options, work).go(next, done, goes_on);
}

}  // namespace wunderlich::sweep
