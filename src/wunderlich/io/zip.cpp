#include "wunderlich/io/zip.hpp"

#include <array>
#include <limits>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/bytes.hpp"

namespace wunderlich::io {

namespace {

// Constants of PKWARE's APPNOTE, 4.3.
constexpr std::uint32_t local_header = 0x04034b50, central_header = 0x02014b50, end_of_archive = 0x06054b50;
constexpr std::uint16_t version_needed = 20, first_of_january_1980 = 0x21;

constexpr std::array<std::uint32_t, 256> crc_table = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}();

void append_zeros(std::string& out, std::size_t count) { out.append(count, '\0'); }

/// What the header before a file and its entry in the directory have in common.
void append_entry(std::string& out, const std::string& name, const std::string& content, std::uint32_t crc) {
  append(out, version_needed);
  append_zeros(out, 2 + 2 + 2);  // flags, stored, midnight
  append(out, first_of_january_1980);
  append(out, crc);
  append(out, static_cast<std::uint32_t>(content.size()));
  append(out, static_cast<std::uint32_t>(content.size()));
  append(out, static_cast<std::uint16_t>(name.size()));
  append_zeros(out, 2);  // no extra field
}

}  // namespace

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t c = 0xFFFFFFFFu;
  for (const char byte : bytes) c = crc_table[(c ^ static_cast<unsigned char>(byte)) & 0xFFu] ^ (c >> 8);
  return c ^ 0xFFFFFFFFu;
}

std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::size_t total = 0;
  for (const auto& [name, content] : files) total += content.size() + 2 * name.size() + 100;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("the archive would have more than 4 GB; lower output.subdivision or output.across");
  }
  std::string out, directory;
  out.reserve(total);
  for (const auto& [name, content] : files) {
    const auto offset = static_cast<std::uint32_t>(out.size());
    const std::uint32_t crc = crc32(content);
    append(out, local_header);
    append_entry(out, name, content, crc);
    out += name + content;
    append(directory, central_header);
    append(directory, version_needed);
    append_entry(directory, name, content, crc);
    append_zeros(directory, 2 + 2 + 2 + 4);  // no comment, first disk, no attributes
    append(directory, offset);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(out.size());
  out += directory;
  append(out, end_of_archive);
  append_zeros(out, 2 + 2);  // this disk, and that of the directory
  for (int twice = 0; twice < 2; ++twice) append(out, static_cast<std::uint16_t>(files.size()));
  append(out, static_cast<std::uint32_t>(directory.size()));
  append(out, start);
  append_zeros(out, 2);  // no comment
  return out;
}

}  // namespace wunderlich::io
