/// The run folder: replaced whole, or left as it was.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wunderlich/io/formats.hpp"
#include "wunderlich/io/output_folder.hpp"
#include "wunderlich/io/run_output.hpp"

namespace wunderlich::io {

/// Names of the files that every run folder holds; by the first two one is recognised.
inline constexpr const char* summary_file = "summary.json";
inline constexpr const char* checkpoint_file = "checkpoint";
inline constexpr const char* centerline_file = "centerline.csv";
inline constexpr const char* history_file = "history.csv";

/// Whether a folder is one that `write_run_folder` wrote.
bool is_run_folder(const std::filesystem::path& folder);

/// Throws InputError, naming the folder, if a run could not be written there: it exists and is neither empty nor a
/// run folder, it is a file, or the place cannot be written. To be called before the work. Creates missing parents.
void require_writable(const std::filesystem::path& folder);

/// The files of one format. `stem` replaces the name `ribbon` (`pattern`, `report`, `picture`, `film` for svg, html,
/// png, mp4).
std::vector<RenderedFile> render(Format format, const RunOutput& output, const std::string& stem = "");

/// Writes summary.json, centerline.csv, history.csv, the checkpoint and the formats. The folder appears under its
/// name only when it is complete; a run folder that was there is replaced. Throws InputError as `require_writable`
/// does, or if a disk is full; std::domain_error if a number is not finite. In either case nothing is left behind.
void write_run_folder(const std::filesystem::path& folder, const RunOutput& output, const std::vector<Format>& formats);

/// Writes one format to `file` (and, for vtp and pc2, what belongs to it beside it). Throws InputError, also where the
/// file is one of those that every run folder holds.
void write_format(const std::filesystem::path& file, Format format, const RunOutput& output);

}  // namespace wunderlich::io
