/// A file of named arrays and texts from which a run goes on bit for bit.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace wunderlich::io {

/// What the program stores is its own affair; `version` says how, and another one is refused on reading.
struct Checkpoint {
  static constexpr int current_version = 1;
  std::map<std::string, std::string> texts;
  std::map<std::string, std::vector<double>> arrays;  ///< every bit is kept, NaN included
  int version = current_version;
};

/// Magic number, length and checksum, then CBOR.
std::string encode_checkpoint(const Checkpoint& checkpoint);

/// Throws InputError that begins with `origin` if the bytes are foreign, of another version, cut or damaged.
Checkpoint decode_checkpoint(std::string_view bytes, std::string_view origin);

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace wunderlich::io
