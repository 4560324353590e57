/// Folders that are there whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wunderlich::io {

/// A file's path relative to its folder, and its content.
using RenderedFile = std::pair<std::filesystem::path, std::string>;

/// Whether a folder is of a kind that this program wrote, and may replace.
using FolderKind = bool (*)(const std::filesystem::path& folder);

using FolderWriter = std::function<void(const std::vector<RenderedFile>& files)>;

/// Throws InputError, naming the folder, if it could not be written: it exists and is neither empty nor of the kind, it
/// is a file, or the place cannot be written. To be called before the work. Creates missing parents.
void require_replaceable(const std::filesystem::path& folder, FolderKind kind);

/// What `fill` writes becomes the folder when it is complete; one of the kind that was there is replaced. Throws
/// InputError as `require_replaceable` does, or if a disk is full; what `fill` throws goes on. In either case nothing
/// is left behind.
void write_whole_folder(const std::filesystem::path& folder, FolderKind kind,
                        const std::function<void(const FolderWriter& write)>& fill);

}  // namespace wunderlich::io
