#include "wunderlich/io/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/csv.hpp"
#include "wunderlich/io/file.hpp"
#include "wunderlich/io/glb.hpp"
#include "wunderlich/io/obj.hpp"
#include "wunderlich/io/pc2.hpp"
#include "wunderlich/io/report.hpp"
#include "wunderlich/io/solid.hpp"
#include "wunderlich/io/stl.hpp"
#include "wunderlich/io/summary_json.hpp"
#include "wunderlich/io/svg.hpp"
#include "wunderlich/io/three_mf.hpp"
#include "wunderlich/io/vtp.hpp"

namespace wunderlich::io {

namespace fs = std::filesystem;

namespace {

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

/// A file a frame, one alone where nothing moves, and the collection.
void render_bodies(const RunOutput& output, const std::string& stem, std::vector<RenderedFile>& files) {
  const std::string solids = stem.empty() ? "solids" : stem + "_solids";
  const bool still = std::none_of(output.bodies.begin(), output.bodies.end(), moves);
  const std::size_t count = still ? 1 : output.frames.size();
  std::vector<std::string> names;
  std::vector<double> times;
  for (std::size_t k = 0; k < count; ++k) {
    names.push_back(fmt::format("{}/frame_{:04}.vtp", solids, k));
    times.push_back(output.frames[k].time);
    files.emplace_back(names.back(), vtp(output.bodies, k, times.back()));
  }
  files.emplace_back(solids + ".pvd", pvd(times, names));
}

std::vector<RenderedFile> render_vtp(const RunOutput& output, const std::string& stem) {
  const std::string frames = stem.empty() ? "frames" : stem + "_frames";
  std::vector<RenderedFile> files;
  if (!output.bodies.empty()) render_bodies(output, stem, files);
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
    const std::string which = output.patterns.size() > 1 ? fmt::format(", ribbon {}", i + 1) : "";
    const std::string rest = output.summary.converged ? "" : " (did not come to its end)";
    files.emplace_back(name, pattern_svg(output.patterns[i], fmt::format("{}{}{}", output.summary.scene, which, rest)));
  }
  return files;
}

/// An export does not replace what the run itself consists of.
void require_no_part_of_run(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const char* const own : {summary_file, checkpoint_file, centerline_file, history_file}) {
    if (name == own && is_run_folder(fs::absolute(file).parent_path())) {
      throw InputError(fmt::format("{}: is a part of the run; give the file another name", file.string()));
    }
  }
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / summary_file, error) && fs::is_regular_file(folder / checkpoint_file, error);
}

void require_writable(const fs::path& folder) { require_replaceable(folder, is_run_folder); }

std::vector<RenderedFile> render(Format format, const RunOutput& output, const std::string& stem) {
  assert(!output.frames.empty());
  const std::string ribbon = stem.empty() ? "ribbon" : stem;
  const Mesh& final_surface = output.frames.back().surface;
  switch (format) {
    case Format::vtp:
      return render_vtp(output, stem);
    case Format::glb:
      return {{ribbon + ".glb", glb(output.frames, output.bodies, output.summary.scene)}};
    case Format::pc2:
      return {{ribbon + "_rest.obj", obj(output.frames.front().surface, "ribbon")},
              {ribbon + ".pc2", pc2(output.frames)}};
    case Format::obj:
      return {{ribbon + ".obj", output.thickness ? obj(solids(output), "ribbon") : obj(final_surface, "ribbon")}};
    case Format::stl:
      return {{ribbon + ".stl", stl(solids(output), output.summary.scene)}};
    case Format::mf3:
      return {{ribbon + ".3mf", three_mf(solids(output), output.summary.scene)}};
    case Format::svg:
      return render_patterns(output, stem.empty() ? "pattern" : stem);
    case Format::html:
      return {{(stem.empty() ? "report" : stem) + ".html", report_page(output)}};
    case Format::png:
      return {{(stem.empty() ? "picture" : stem) + ".png", output.png(output)}};
    case Format::mp4:
      return {{(stem.empty() ? "film" : stem) + ".mp4", output.mp4(output)}};
  }
  assert(false);
  return {};
}

void write_run_folder(const fs::path& folder, const RunOutput& output, const std::vector<Format>& formats) {
  require_finite(output);
  write_whole_folder(folder, is_run_folder, [&](const FolderWriter& write) {
    write({{summary_file, summary_json(output.summary)},
           {centerline_file, centerline_csv(output.frames.back().centerline)},
           {history_file, history_csv(output.history)},
           {checkpoint_file, encode_checkpoint(output.checkpoint)}});
    for (const Format format : formats) write(render(format, output));
  });
}

void write_format(const fs::path& file, Format format, const RunOutput& output) {
  require_finite(output);
  require_no_part_of_run(file);
  const fs::path folder = file.parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: cannot be created: {}", file.string(), error.message()));
  const std::vector<RenderedFile> files = render(format, output, file.stem().string());
  for (const auto& [name, bytes] : files) {
    // The last one is the file asked for: it appears when what it refers to is there.
    const bool main = &bytes == &files.back().second;
    const fs::path path = main ? file : folder / name;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (error) throw InputError(fmt::format("{}: cannot be created: {}", path.string(), error.message()));
    write_file(path, bytes);
  }
}

}  // namespace wunderlich::io
