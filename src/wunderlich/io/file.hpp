/// Files that are there whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace wunderlich::io {

/// Writes under a temporary name beside `path`, then renames: `path` holds its old content or the new one, never
/// a part. Throws InputError, naming the path and the system's reason, and leaves nothing behind.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates or overwrites `path` in place: for folders that are renamed as a whole. Throws InputError.
void write_in_place(const std::filesystem::path& path, std::string_view bytes);

/// The whole file. Throws InputError if it cannot be read or is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit = std::size_t{1} << 31);

/// A name beside `path` that no other process of this machine uses: hidden, marked with `purpose`.
std::filesystem::path sibling(const std::filesystem::path& path, std::string_view purpose);

}  // namespace wunderlich::io
