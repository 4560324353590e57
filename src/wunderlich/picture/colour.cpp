#include "wunderlich/picture/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "wunderlich/picture/fields.hpp"

namespace wunderlich::picture {

namespace {

/// From negative to positive, close to "RdBu" of ColorBrewer, as on the report page.
constexpr std::array<unsigned, 7> stops{0x05488f, 0x4393c3, 0xaad0e4, 0xf3f0eb, 0xf7bb96, 0xd6604d, 0x960c26};

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

/// Rounding makes curvatures of about 1e-16 over the size of a strip; what is below this is none.
double nothing(const Frame& frame, Colour colour) {
  constexpr double kNothing = 1e-10;
  if (colour == Colour::eta) return kNothing;
  const std::vector<double> u = values_of(frame.surface, "u");
  const double curvature = kNothing / *std::max_element(u.begin(), u.end());
  return colour == Colour::energy ? curvature * curvature : curvature;
}

}  // namespace

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
  const double least = nothing(*frames.front(), colour);
  return most > least ? most : sizes.back() > least ? sizes.back() : 1;
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
