#include "wunderlich/io/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "wunderlich/base/error.hpp"

namespace wunderlich::io {

namespace {

constexpr std::array<std::pair<Format, std::string_view>, 10> names{{{Format::vtp, "vtp"},
                                                                     {Format::glb, "glb"},
                                                                     {Format::pc2, "pc2"},
                                                                     {Format::obj, "obj"},
                                                                     {Format::stl, "stl"},
                                                                     {Format::mf3, "3mf"},
                                                                     {Format::svg, "svg"},
                                                                     {Format::html, "html"},
                                                                     {Format::png, "png"},
                                                                     {Format::mp4, "mp4"}}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::string_view name(Format format) {
  return std::find_if(names.begin(), names.end(), [&](const auto& entry) { return entry.first == format; })->second;
}

std::string format_names() {
  std::string list;
  for (const auto& [format, known] : names) list += (list.empty() ? "" : ", ") + std::string(known);
  return list;
}

Format parse_format(std::string_view text) {
  if (text == "svg-pattern") return Format::svg;
  for (const auto& [format, known] : names) {
    if (known == text) return format;
  }
  throw InputError(fmt::format("unknown format '{}'; allowed are {}", text, format_names()));
}

std::vector<Format> parse_formats(std::string_view list) {
  if (trimmed(list) == "none") return {};
  std::vector<Format> formats;
  while (true) {
    const std::size_t comma = list.find(',');
    const std::string_view one = trimmed(list.substr(0, comma));
    if (one == "none") throw InputError(fmt::format("none stands alone; allowed are {}", format_names()));
    const Format format = parse_format(one);
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
    if (comma == std::string_view::npos) return formats;
    list.remove_prefix(comma + 1);
  }
}

}  // namespace wunderlich::io
