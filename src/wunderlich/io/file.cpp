#include "wunderlich/io/file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "wunderlich/base/error.hpp"

namespace wunderlich::io {

namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view verb, int reason) {
  throw InputError(fmt::format("{}: cannot {}: {}", path.string(), verb, std::strerror(reason)));
}

/// 0, or the errno of what went wrong.
int write_bytes(const std::filesystem::path& path, std::string_view bytes, bool sync) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  int reason = 0;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0 &&
                       (!sync || ::fsync(::fileno(file)) == 0 || errno == EINVAL);
  if (!written) reason = errno != 0 ? errno : EIO;
  // A full disk may show only now.
  if (std::fclose(file) != 0 && reason == 0) reason = errno != 0 ? errno : EIO;
  return reason;
}

}  // namespace

std::filesystem::path sibling(const std::filesystem::path& path, std::string_view purpose) {
  return path.parent_path() / fmt::format(".{}.{}-{}", path.filename().string(), purpose, ::getpid());
}

void write_in_place(const std::filesystem::path& path, std::string_view bytes) {
  const int reason = write_bytes(path, bytes, false);
  if (reason != 0) fail(path, "write", reason);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path temporary = sibling(path, "partial");
  const int reason = write_bytes(temporary, bytes, true);
  std::error_code error;
  if (reason == 0) std::filesystem::rename(temporary, path, error);
  if (reason == 0 && !error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  fail(path, "write", reason != 0 ? reason : error.value());
}

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail(path, "read", EISDIR);
  errno = 0;
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "read", errno);
  std::string bytes;
  char block[1 << 16];
  while (const std::size_t count = std::fread(block, 1, sizeof block, file.get())) {
    bytes.append(block, count);
    if (bytes.size() > limit) {
      throw InputError(fmt::format("{}: larger than {} bytes, the most that is read", path.string(), limit));
    }
  }
  if (std::ferror(file.get()) != 0) fail(path, "read", errno != 0 ? errno : EIO);
  return bytes;
}

}  // namespace wunderlich::io
