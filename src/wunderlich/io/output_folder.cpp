#include "wunderlich/io/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cstdio>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/file.hpp"

namespace wunderlich::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& folder, const std::string& problem) {
  throw InputError(fmt::format("{}: {}", folder.string(), problem));
}

/// Without `..`, links and a slash at the end, so that renaming it means what it says.
fs::path resolved(const fs::path& folder) {
  std::error_code error;
  fs::path out = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (error || folder.empty()) fail(folder, "cannot be used as an output folder: " + error.message());
  return out.has_filename() ? out : out.parent_path();
}

/// A folder under construction, removed unless it was put in place.
class Draft {
 public:
  explicit Draft(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directory(path_, error);
    if (error) fail(path_.parent_path(), fmt::format("cannot be written: {}", error.message()));
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Swaps two folders in one step where the system can: then there is no moment without a run folder.
bool exchange(const fs::path& a, const fs::path& b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  (void)a, (void)b;
  return false;
#endif
}

/// Puts the draft at `folder`; what was there ends up in the draft's place or is removed.
void put_in_place(const Draft& draft, const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && exchange(draft.path(), folder)) return;
  const fs::path old = sibling(folder, "old");
  const bool existed = fs::exists(folder, error);
  if (existed) fs::rename(folder, old, error);
  if (!error) fs::rename(draft.path(), folder, error);
  if (error) {
    const std::string reason = error.message();
    if (existed && !fs::exists(folder, error)) fs::rename(old, folder, error);
    fail(folder, "cannot be replaced: " + reason);
  }
  if (existed) fs::remove_all(old, error);
}

void write_all(const fs::path& folder, const std::vector<RenderedFile>& files) {
  for (const auto& [name, bytes] : files) {
    std::error_code error;
    if (name.has_parent_path()) fs::create_directories(folder / name.parent_path(), error);
    if (error) fail(folder / name, "cannot be written: " + error.message());
    write_in_place(folder / name, bytes);
  }
}

}  // namespace

void require_replaceable(const fs::path& folder, FolderKind kind) {
  const fs::path target = resolved(folder);
  std::error_code error;
  if (fs::exists(target, error)) {
    if (!fs::is_directory(target, error)) fail(folder, "is a file; an output folder is needed");
    const bool empty = fs::is_empty(target, error);
    if (error) fail(folder, "cannot be read: " + error.message());
    if (!empty && !kind(target)) {
      fail(folder,
           "exists and was not written by wunderlich; only a folder that it wrote is replaced, choose another --out");
    }
  }
  fs::create_directories(target.parent_path(), error);
  if (error) fail(folder, "cannot be created: " + error.message());
  const Draft probe(sibling(target, "probe"));
}

void write_whole_folder(const fs::path& folder, FolderKind kind,
                        const std::function<void(const FolderWriter& write)>& fill) {
  require_replaceable(folder, kind);
  const fs::path target = resolved(folder);
  const Draft draft(sibling(target, "partial"));
  fill([&](const std::vector<RenderedFile>& files) { write_all(draft.path(), files); });
  put_in_place(draft, target);
}

}  // namespace wunderlich::io
