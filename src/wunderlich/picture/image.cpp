#include "wunderlich/picture/image.hpp"

#include <png.h>

#include <stdexcept>

namespace wunderlich::picture {

std::string png(const Image& image) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<png_uint_32>(image.width);
  head.height = static_cast<png_uint_32>(image.height);
  head.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(head);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&head, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("libpng: ") + head.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace wunderlich::picture
