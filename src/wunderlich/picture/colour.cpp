#include "wunderlich/picture/colour.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// From negative to positive, close to "RdBu" of ColorBrewer, as on the report page.
constexpr std::array<unsigned, 7> stops{0x05488f, 0x4393c3, 0xaad0e4, 0xf3f0eb, 0xf7bb96, 0xd6604d, 0x960c26};

std::vector<double> values_of(const Mesh& surface, std::string_view name) {
  for (const PointField& field : surface.fields) {
    if (field.name == name) return field.values;
  }
  return std::vector<double>(surface.points.size(), 0.0);
}

/// d eta / du at each point of the surface: eta is linear between nodes.
std::vector<double> slopes_of(const Frame& frame) {
  const std::vector<double> u = values_of(frame.surface, "u"), strip = values_of(frame.surface, "ribbon");
  const std::vector<CenterlineSample>& line = frame.centerline;
  std::vector<double> slopes(u.size(), 0.0);
  std::size_t k = 0;  // points and nodes come in the same order
  for (std::size_t i = 0; i < u.size(); ++i) {
    while (k + 2 < line.size() &&
           (line[k].ribbon < static_cast<int>(strip[i]) || line[k + 1].ribbon != line[k].ribbon ||
            (line[k + 1].u < u[i] && line[k + 2].ribbon == line[k].ribbon))) {
      ++k;
    }
    slopes[i] = (line[k + 1].eta - line[k].eta) / (line[k + 1].u - line[k].u);
  }
  return slopes;
}

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

float linear_of(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

float srgb_of(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Eigen::Vector3f linear_of(unsigned rgb) {
  const auto part = [&](unsigned shift) { return linear_of(static_cast<float>((rgb >> shift) & 255u) / 255.0f); };
  return {part(16), part(8), part(0)};
}

std::vector<double> field_of(const Frame& frame, Colour colour) {
  if (colour != Colour::energy) return values_of(frame.surface, name(colour));
  std::vector<double> out = values_of(frame.surface, "kappa");
  const std::vector<double> eta = values_of(frame.surface, "eta"), v = values_of(frame.surface, "v");
  const std::vector<double> slope = slopes_of(frame);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double principal = out[i] * (1 + eta[i] * eta[i]) / (1 + v[i] * slope[i]);
    out[i] = principal * principal;
  }
  return out;
}

double range_of(const std::vector<const Frame*>& frames, Colour colour) {
  std::vector<double> sizes;
  for (const Frame* frame : frames) {
    for (const double value : field_of(*frame, colour)) sizes.push_back(std::abs(value));
  }
  std::sort(sizes.begin(), sizes.end());
  const double below = colour == Colour::energy ? 0.9 : 0.98;
  const double most = sizes[static_cast<std::size_t>(below * static_cast<double>(sizes.size() - 1))];
  return most > 0 ? most : sizes.back() > 0 ? sizes.back() : 1;
}

double share_of(double value, double range, Colour colour) {
  return colour == Colour::energy ? std::sqrt(value / range) : value / range;
}

Eigen::Vector3f colour_of(double share) {
  const double last = static_cast<double>(stops.size() - 1);
  const double at = 0.5 * last * (std::clamp(share, -1.0, 1.0) + 1);
  const auto k = static_cast<std::size_t>(std::min(last - 1, std::floor(at)));
  const auto mix = static_cast<float>(at - static_cast<double>(k));
  Eigen::Vector3f out;
  for (int c = 0; c < 3; ++c) {
    const auto part = [&](unsigned rgb) { return static_cast<float>((rgb >> (16 - 8 * c)) & 255u) / 255.0f; };
    out[c] = linear_of(part(stops[k]) + mix * (part(stops[k + 1]) - part(stops[k])));
  }
  return out;
}

}  // namespace wunderlich::picture
