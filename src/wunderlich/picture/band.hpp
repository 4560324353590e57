/// A band of rows of a picture: depth, light, lines. Internal to picture/.
#pragma once

#include "wunderlich/picture/image.hpp"
#include "wunderlich/picture/sheet.hpp"

namespace wunderlich::picture {

/// Draws some rows of the picture; bands can be drawn side by side.
void draw_band(const Sheet& sheet, int first_row, int rows, Image& image);

}  // namespace wunderlich::picture
