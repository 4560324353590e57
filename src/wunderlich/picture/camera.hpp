/// Where to look from. Everything is drawn in stage coordinates: (p - fit.centre) / fit.radius.
#pragma once

#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/picture/style.hpp"

namespace wunderlich::picture {

/// What part of space a frame fills.
struct Fit {
  Vec3 centre = Vec3::Zero();
  double radius = 1;  ///< [m]
  double floor = 0;   ///< lowest z of the ribbon [m]

  Vec3 on_stage(const Vec3& p) const { return (p - centre) / radius; }
};

/// Axes of the picture; `towards` points at the eye.
struct View {
  Vec3 towards, right, up;
};

/// A pinhole in stage coordinates.
struct Camera {
  View view;
  Vec3 eye = Vec3::Zero();
  double half_height = 1;  ///< of the picture, at distance 1
  double aspect = 1;       ///< width / height
};

View view_from(const Direction& direction);

/// The view from which most of the surface is seen, a little from above and rather from the usual side.
View best_view(const Mesh& surface);

/// Points of each frame that are to be seen: the ribbon, and bodies that are not much larger.
std::vector<std::vector<Vec3>> shown_points(const std::vector<const Frame*>& frames, const std::vector<Body>& bodies,
                                            const std::vector<std::size_t>& indices);

/// One fit for all frames where that shows the last one well; else the view follows the ribbon.
std::vector<Fit> fits_of(const std::vector<std::vector<Vec3>>& points);

/// The camera from which every frame, moved and scaled by its fit, is in the picture.
Camera frame_all(const View& view, double aspect, const std::vector<std::vector<Vec3>>& points,
                 const std::vector<Fit>& fits);

}  // namespace wunderlich::picture
