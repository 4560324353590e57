#include "wunderlich/sweep/store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "wunderlich/base/error.hpp"

namespace wunderlich::sweep {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& problem) {
  throw InputError(fmt::format("{}: {}", path.string(), problem));
}

/// A process that was just killed holds its locks a moment longer.
bool lock(int file) {
  for (int k = 0; k < 20; ++k) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return false;
    ::usleep(50'000);
  }
  return false;
}

/// Calls `visit(offset, line)` for each whole line; returns where the last one that is sound ends.
template <class Visit>
std::uint64_t each_line(const fs::path& path, Visit visit) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "cannot be read");
  std::string line;
  std::uint64_t offset = 0, sound = 0;
  while (std::getline(in, line)) {
    const bool whole = !in.eof();
    const std::uint64_t next = offset + line.size() + 1;
    if (whole && visit(offset, line)) sound = next;
    offset = next;
  }
  return sound;
}

}  // namespace

Writer::Writer(const fs::path& folder, const std::string& name) : path_(folder / "results" / (name + ".log")) {
  std::error_code error;
  fs::create_directories(path_.parent_path(), error);
  if (error) fail(path_, "cannot be created: " + error.message());
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
  if (!lock(file_)) {
    const int reason = errno;
    ::close(file_);
    fail(path_, reason == EWOULDBLOCK ? "another process is at work on this part of the sweep"
                                      : fmt::format("cannot be locked: {}", std::strerror(reason)));
  }
  // Every line before a damaged one was written before it.
  const std::uint64_t sound =
      each_line(path_, [](std::uint64_t, const std::string& line) { return parse_line(line).has_value(); });
  if (::ftruncate(file_, static_cast<off_t>(sound)) != 0)
    fail(path_, fmt::format("cannot be cut: {}", std::strerror(errno)));
}

Writer::~Writer() { ::close(file_); }

void Writer::add(const Record& record) {
  const std::string line = line_of(record);
  const off_t before = ::lseek(file_, 0, SEEK_END);
  const ssize_t written = ::write(file_, line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size())) return;
  const int reason = written < 0 ? errno : ENOSPC;
  const bool cut = ::ftruncate(file_, before) == 0;
  fail(path_, fmt::format("cannot be written: {}{}", std::strerror(reason), cut ? "" : "; its last line is torn"));
}

bool is_busy(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "results", error)) {
    const int file = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    const bool busy = ::flock(file, LOCK_SH | LOCK_NB) != 0;
    ::close(file);
    if (busy) return true;
  }
  return false;
}

Store::Store(const fs::path& folder) {
  std::error_code error;
  const fs::path results = folder / "results";
  if (!fs::is_directory(results, error)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(results)) {
    if (entry.path().extension() == ".log") logs_.push_back(entry.path());
  }
  std::sort(logs_.begin(), logs_.end());
  for (std::uint32_t log = 0; log < logs_.size(); ++log) {
    each_line(logs_[log], [&](std::uint64_t offset, const std::string& line) {
      const auto record = parse_line(line);
      if (record) places_.insert_or_assign(record->key, Found{log, offset, record->status});
      return record.has_value();
    });
  }
}

const Found* Store::find(const std::string& key) const {
  const auto found = places_.find(key);
  return found == places_.end() ? nullptr : &found->second;
}

Record Store::read(const Found& found) {
  open_.resize(logs_.size());
  std::ifstream& in = open_[found.log];
  if (!in.is_open()) {
    constexpr std::size_t kMostOpen = 100;
    if (++opened_ % kMostOpen == 0) {
      for (std::ifstream& other : open_) other.close();
    }
    in.open(logs_[found.log], std::ios::binary);
    if (!in) fail(logs_[found.log], "cannot be read");
  }
  in.clear();
  in.seekg(static_cast<std::streamoff>(found.offset));
  std::string line;
  std::getline(in, line);
  auto record = parse_line(line);
  if (!record) fail(logs_[found.log], "changed while it was read");
  return std::move(*record);
}

}  // namespace wunderlich::sweep
