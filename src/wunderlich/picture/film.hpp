/// Films, encoded by ffmpeg.
#pragma once

#include <string>

#include "wunderlich/picture/draw.hpp"

namespace wunderlich::picture {

/// Throws InputError if there is no ffmpeg on the PATH, or the style is none for a film. To be called before the work.
void require_film(const Style& style);

/// The bytes of an MP4 file: every frame, H.264, yuv420p. Throws InputError if ffmpeg is missing or refuses.
std::string film(const Subject& subject, const Style& style);

}  // namespace wunderlich::picture
