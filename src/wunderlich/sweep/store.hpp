/// The results of a sweep on disk: logs to which finished runs are added, one a writer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unordered_map>
#include <vector>

#include "wunderlich/sweep/record.hpp"

namespace wunderlich::sweep {

/// Adds lines to one log, `results/NAME.log` of a sweep's folder. A line is written in one piece; what a killed writer
/// left of one is cut off when the log is opened again. One writer at a time: throws InputError if there is another.
class Writer {
 public:
  Writer(const std::filesystem::path& folder, const std::string& name);
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer();

  /// Throws InputError if the disk is full; the log then ends as it did before.
  void add(const Record& record);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

/// Is a writer at work in the folder?
bool is_busy(const std::filesystem::path& folder);

/// Where a record stands.
struct Found {
  std::uint32_t log = 0;
  std::uint64_t offset = 0;
  Status status = Status::failed;
};

/// All records of a folder by their keys, found but not kept: memory does not grow with what they hold.
class Store {
 public:
  explicit Store(const std::filesystem::path& folder);
  const Found* find(const std::string& key) const;
  Record read(const Found& found);
  std::size_t size() const { return places_.size(); }

 private:
  std::vector<std::filesystem::path> logs_;
  std::vector<std::ifstream> open_;  ///< the logs, as far as they have been read from
  std::size_t opened_ = 0;           ///< how often one was
  std::unordered_map<std::string, Found> places_;
};

}  // namespace wunderlich::sweep
