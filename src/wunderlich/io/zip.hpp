/// Zip archives of stored (not compressed) files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wunderlich::io {

/// CRC-32 as zip and PNG have it: polynomial 0xEDB88320, reflected.
std::uint32_t crc32(std::string_view bytes);

/// Name and content of each file, in their order; names are ASCII with `/` between folders. No times: the same files
/// give the same bytes. Throws InputError beyond 4 GB, which plain zip cannot say.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace wunderlich::io
