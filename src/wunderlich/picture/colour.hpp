/// Colours of fields on the surface.
#pragma once

#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/picture/style.hpp"

namespace wunderlich::picture {

/// Components of a colour as screens take them, to light and back.
float linear_of(float srgb);
float srgb_of(float linear);
Eigen::Vector3f linear_of(unsigned rgb);

/// Values of a field at the points of a frame's surface, in the field's unit. The energy is that per area over D / 2:
/// the principal curvature squared [1/m^2]. @eq Shen2015:3 (its integrand)
std::vector<double> field_of(const Frame& frame, Colour colour);

/// What most values stay below, so that a spike does not wash out the rest: all but two per cent, and of energies,
/// which gather at inflections, all but ten. Above 0.
double range_of(const std::vector<const Frame*>& frames, Colour colour);

/// The share of the range that a value is drawn at: of energies the root.
double share_of(double value, double range, Colour colour);

/// Linear colour of a share from -1, blue, to 1, red.
Eigen::Vector3f colour_of(double share);

}  // namespace wunderlich::picture
