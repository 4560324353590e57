/// Files as text.
#pragma once

#include <string>

namespace wunderlich::scene {

/// What a regular file holds, at most so many bytes, so that no device or growing file can fill the memory. Throws
/// InputError that names the path; `what` says what the file should be.
std::string file_text(const std::string& path, std::size_t most, const std::string& what);

}  // namespace wunderlich::scene
