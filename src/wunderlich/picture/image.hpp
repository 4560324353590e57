/// A picture in memory, and as PNG.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wunderlich::picture {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< sRGB, rows from the top
};

/// The bytes of a PNG file.
std::string png(const Image& image);

}  // namespace wunderlich::picture
