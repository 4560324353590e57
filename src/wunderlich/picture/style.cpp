#include "wunderlich/picture/style.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "wunderlich/base/error.hpp"

namespace wunderlich::picture {

namespace {

constexpr std::array<std::pair<Colour, std::string_view>, 5> names{{{Colour::plain, "plain"},
                                                                    {Colour::kappa, "kappa"},
                                                                    {Colour::tau, "tau"},
                                                                    {Colour::eta, "eta"},
                                                                    {Colour::energy, "energy"}}};

bool parse_integer(std::string_view text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool parse_degrees(std::string_view text, double& radians) {
  double degrees = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), degrees);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(degrees)) return false;
  radians = std::remainder(degrees, 360.0) * std::numbers::pi / 180;
  return true;
}

}  // namespace

void parse_size(std::string_view text, Style& style) {
  const std::size_t cross = text.find('x');
  const auto allowed = [](int side) { return side >= smallest_side && side <= largest_side; };
  if (cross == std::string_view::npos || !parse_integer(text.substr(0, cross), style.width) ||
      !parse_integer(text.substr(cross + 1), style.height) || !allowed(style.width) || !allowed(style.height)) {
    throw InputError(
        fmt::format("--size: '{}' is not allowed; must be WIDTHxHEIGHT, each from {} to {} pixels: 1200x750", text,
                    smallest_side, largest_side));
  }
}

Direction parse_direction(std::string_view text) {
  const std::size_t comma = text.find(',');
  Direction direction;
  if (comma == std::string_view::npos || !parse_degrees(text.substr(0, comma), direction.azimuth) ||
      !parse_degrees(text.substr(comma + 1), direction.elevation) ||
      std::abs(direction.elevation) > 0.5 * std::numbers::pi) {
    throw InputError(fmt::format(
        "--view: '{}' is not allowed; must be AZIMUTH,ELEVATION in degrees, the latter from -90 to 90: 30,20", text));
  }
  return direction;
}

Colour parse_colour(std::string_view text) {
  std::string all;
  for (const auto& [colour, known] : names) {
    if (known == text) return colour;
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw InputError(fmt::format("--colour: '{}' is not allowed; must be one of {}", text, all));
}

std::string_view name(Colour colour) { return names[static_cast<std::size_t>(colour)].second; }

}  // namespace wunderlich::picture
