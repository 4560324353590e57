/// Solids as triangles, for pictures.
#pragma once

#include "wunderlich/base/frame.hpp"
#include "wunderlich/contact/shape.hpp"

namespace wunderlich::contact {

/// The surface in the solid's own frame, triangles counter-clockwise seen from outside. What has no end is cut off
/// `extent` away from the origin [m].
Mesh mesh_of(const Shape& shape, double extent);

}  // namespace wunderlich::contact
