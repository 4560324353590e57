#include "wunderlich/scene/file_text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

std::string file_text(const std::string& path, std::size_t most, const std::string& what) {
  const std::string name = shown(path, 4096);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(name + ": is a folder; this is for " + what);
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": is not a regular file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(name + ": cannot be read: " + std::strerror(errno));
  std::string text(most + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw InputError(name + ": cannot be read: " + std::strerror(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > most) {
    throw InputError(fmt::format("{}: is larger than {} MiB, too large for {}", name, most >> 20, what));
  }
  return text;
}

}  // namespace wunderlich::scene
