/// How a run is drawn.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wunderlich::picture {

enum class Colour {
  plain,   ///< paper, the back of a two-sided strip in its own colour
  kappa,   ///< blue where negative, red where positive, as are tau and eta
  tau,     ///
  eta,     ///
  energy,  ///< of bending, per area, from pale to red
};

/// Where the eye is [rad]: 0, 0 looks along +y with z up; azimuth turns the eye anticlockwise seen from above,
/// elevation lifts it.
struct Direction {
  double azimuth = 0;
  double elevation = 0;
};

struct Style {
  int width = 1200;  ///< [pixels]
  int height = 750;  ///< [pixels]
  Colour colour = Colour::plain;
  std::optional<Direction> view;     ///< none: from where most of the shape is seen
  std::optional<std::size_t> frame;  ///< of a still; none: the last
  double zoom = 1;                   ///< on the middle of the shape; 1: all of it is seen
  double fps = 25;                   ///< of a film: recorded frames a second
};

inline constexpr int smallest_side = 16;   // pixels
inline constexpr int largest_side = 8192;  // pixels
inline constexpr double largest_zoom = 100;
inline constexpr double smallest_fps = 0.1, largest_fps = 240;

/// "1200x750", "30,20" in degrees, "kappa". Each throws InputError with what would be right.
void parse_size(std::string_view text, Style& style);
Direction parse_direction(std::string_view text);
Colour parse_colour(std::string_view text);
std::string_view name(Colour colour);

}  // namespace wunderlich::picture
