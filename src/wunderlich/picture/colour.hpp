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

/// What most values stay below: all but two per cent, so that a spike does not wash out the rest. Above 0.
double range_of(const std::vector<const Frame*>& frames, Colour colour);

/// Linear colour of a value: diverging, but for energies, which use the upper half.
Eigen::Vector3f colour_of(double value, double range);

}  // namespace wunderlich::picture
