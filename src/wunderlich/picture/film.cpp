#include "wunderlich/picture/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include "wunderlich/base/error.hpp"

namespace wunderlich::picture {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& what) { throw InputError("film: " + what); }

/// A folder of this film's own, gone with it.
struct Scratch {
  fs::path folder;
  Scratch() {
    std::string name = (fs::temp_directory_path() / "wunderlich-film-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) fail("no folder can be made in " + fs::temp_directory_path().string());
    folder = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

fs::path find_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    fs::path candidate = fs::path(rest.substr(0, colon)) / "ffmpeg";
    std::error_code error;
    if (colon > 0 && fs::is_regular_file(candidate, error) && ::access(candidate.c_str(), X_OK) == 0) return candidate;
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  fail("ffmpeg is needed for mp4 and is not on the PATH; on Debian: apt-get install ffmpeg");
}

/// ffmpeg, which reads raw pictures from us and writes a file and its complaints into the scratch folder.
class Encoder {
 public:
  Encoder(const Style& style, const Scratch& scratch) : complaints_(scratch.folder / "log") {
    // A socket, as writing to one whose reader is gone is an error and not the end of this process.
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("no socket can be made");
    socket_ = ends[0];
    const std::string size = fmt::format("{}x{}", style.width, style.height), rate = fmt::format("{:g}", style.fps);
    std::vector<std::string> words{find_ffmpeg().string(),
                                   "-v",
                                   "error",
                                   "-nostdin",
                                   "-f",
                                   "rawvideo",
                                   "-pix_fmt",
                                   "rgb24",
                                   "-s",
                                   size,
                                   "-r",
                                   rate,
                                   "-i",
                                   "pipe:0",
                                   "-c:v",
                                   "libx264",
                                   "-preset",
                                   "medium",
                                   "-crf",
                                   "17",
                                   "-vf",
                                   "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int",
                                   "-colorspace",
                                   "bt709",
                                   "-color_primaries",
                                   "bt709",
                                   "-color_trc",
                                   "iec61966-2-1",
                                   "-pix_fmt",
                                   "yuv420p",
                                   "-movflags",
                                   "+faststart",
                                   (scratch.folder / "film.mp4").string()};
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, complaints_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
    const int error = ::posix_spawn(&process_, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (error != 0) {
      ::close(socket_);
      fail("ffmpeg cannot be started");
    }
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { wait(); }

  /// False when ffmpeg takes no more.
  bool take(const Image& image) const {
    const auto* bytes = image.rgb.data();
    std::size_t left = image.rgb.size();
    while (left > 0) {
      const ssize_t sent = ::send(socket_, bytes, left, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return false;
      bytes += sent;
      left -= static_cast<std::size_t>(sent);
    }
    return true;
  }

  void finish() {
    const int status = wait();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    std::string said = content(complaints_);
    while (!said.empty() && said.back() == '\n') said.pop_back();
    fail("ffmpeg failed: " + said.substr(said.rfind('\n') == std::string::npos ? 0 : said.rfind('\n') + 1));
  }

 private:
  int wait() {
    if (process_ <= 0) return 0;
    ::close(socket_);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

  fs::path complaints_;
  int socket_ = -1;
  pid_t process_ = 0;
};

}  // namespace

void require_film(const Style& style) {
  find_ffmpeg();
  if (style.width % 2 != 0 || style.height % 2 != 0) {
    throw InputError(
        fmt::format("--size: {}x{} is not allowed; the sides of a film must be even", style.width, style.height));
  }
}

std::string film(const Subject& subject, const Style& style) {
  require_film(style);
  std::vector<std::size_t> frames(subject.frames.size());
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  const Plan shots = plan(subject, style, frames);
  const Scratch scratch;
  Encoder encoder(style, scratch);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!encoder.take(draw(subject, style, shots, k))) break;
  }
  encoder.finish();
  return content(scratch.folder / "film.mp4");
}

}  // namespace wunderlich::picture
