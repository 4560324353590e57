#include "wunderlich/io/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/csv.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/glb.hpp"
#include "wunderlich/io/obj.hpp"
#include "wunderlich/io/pc2.hpp"
#include "wunderlich/io/report.hpp"
#include "wunderlich/io/summary_json.hpp"
#include "wunderlich/io/svg.hpp"
#include "wunderlich/io/vtp.hpp"

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

bool all_finite(const std::vector<Vec3>& vectors) {
  for (const Vec3& v : vectors) {
    if (!v.allFinite()) return false;
  }
  return true;
}

void require_finite(const RunOutput& output) {
  for (const Frame& frame : output.frames) {
    bool finite = all_finite(frame.surface.points) && all_finite(frame.surface.normals) && std::isfinite(frame.time);
    for (const PointField& field : frame.surface.fields) {
      for (const double value : field.values) finite = finite && std::isfinite(value);
    }
    if (!finite) throw std::domain_error(fmt::format("the surface at time {} is not finite", frame.time));
  }
}

void write_all(const fs::path& folder, const std::vector<RenderedFile>& files) {
  for (const auto& [name, bytes] : files) {
    std::error_code error;
    if (name.has_parent_path()) fs::create_directories(folder / name.parent_path(), error);
    if (error) fail(folder / name, "cannot be written: " + error.message());
    write_in_place(folder / name, bytes);
  }
}

std::vector<RenderedFile> render_vtp(const RunOutput& output, const std::string& stem) {
  const std::string frames = stem.empty() ? "frames" : stem + "_frames";
  std::vector<RenderedFile> files;
  std::vector<std::string> names;
  std::vector<double> times;
  for (const Frame& frame : output.frames) {
    names.push_back(fmt::format("{}/frame_{:04}.vtp", frames, names.size()));
    times.push_back(frame.time);
    files.emplace_back(names.back(), vtp(frame.surface, frame.time));
  }
  files.emplace_back((stem.empty() ? "ribbon" : stem) + ".pvd", pvd(times, names));
  return files;
}

/// One a strip; the first one's comes last.
std::vector<RenderedFile> render_patterns(const RunOutput& output, const std::string& stem) {
  std::vector<RenderedFile> files;
  for (std::size_t i = output.patterns.size(); i-- > 0;) {
    const std::string name = i == 0 ? stem + ".svg" : fmt::format("{}-{}.svg", stem, i + 1);
    const std::string title = i == 0 ? output.summary.scene : fmt::format("{}, ribbon {}", output.summary.scene, i + 1);
    files.emplace_back(name, pattern_svg(output.patterns[i], title));
  }
  return files;
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / summary_file, error) && fs::is_regular_file(folder / checkpoint_file, error);
}

void require_writable(const fs::path& folder) {
  const fs::path target = resolved(folder);
  std::error_code error;
  if (fs::exists(target, error)) {
    if (!fs::is_directory(target, error)) fail(folder, "is a file; an output folder is needed");
    const bool empty = fs::is_empty(target, error);
    if (error) fail(folder, "cannot be read: " + error.message());
    if (!empty && !is_run_folder(target)) {
      fail(folder, "exists and was not written by wunderlich; only a run folder is replaced, choose another --out");
    }
  }
  fs::create_directories(target.parent_path(), error);
  if (error) fail(folder, "cannot be created: " + error.message());
  const Draft probe(sibling(target, "probe"));
}

std::vector<RenderedFile> render(Format format, const RunOutput& output, const std::string& stem) {
  assert(!output.frames.empty());
  const std::string ribbon = stem.empty() ? "ribbon" : stem;
  const Mesh& final_surface = output.frames.back().surface;
  switch (format) {
    case Format::vtp:
      return render_vtp(output, stem);
    case Format::glb:
      return {{ribbon + ".glb", glb(output.frames, output.summary.scene)}};
    case Format::pc2:
      return {{ribbon + "_rest.obj", obj(output.frames.front().surface, "ribbon")},
              {ribbon + ".pc2", pc2(output.frames)}};
    case Format::obj:
      return {{ribbon + ".obj", obj(final_surface, "ribbon")}};
    case Format::svg:
      return render_patterns(output, stem.empty() ? "pattern" : stem);
    case Format::html:
      return {{(stem.empty() ? "report" : stem) + ".html", report_page(output)}};
  }
  assert(false);
  return {};
}

void write_run_folder(const fs::path& folder, const RunOutput& output, const std::vector<Format>& formats) {
  require_finite(output);
  require_writable(folder);
  const fs::path target = resolved(folder);
  const Draft draft(sibling(target, "partial"));
  write_all(draft.path(), {{summary_file, summary_json(output.summary)},
                           {"centerline.csv", centerline_csv(output.frames.back().centerline)},
                           {"history.csv", history_csv(output.history)},
                           {checkpoint_file, encode_checkpoint(output.checkpoint)}});
  for (const Format format : formats) write_all(draft.path(), render(format, output));
  put_in_place(draft, target);
}

void write_format(const fs::path& file, Format format, const RunOutput& output) {
  require_finite(output);
  const fs::path folder = file.parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) fail(file, "cannot be created: " + error.message());
  const std::vector<RenderedFile> files = render(format, output, file.stem().string());
  for (const auto& [name, bytes] : files) {
    // The last one is the file asked for: it appears when what it refers to is there.
    const bool main = &bytes == &files.back().second;
    const fs::path path = main ? file : folder / name;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (error) fail(path, "cannot be created: " + error.message());
    write_file(path, bytes);
  }
}

}  // namespace wunderlich::io
