/// Pictures of a run, drawn without a graphics card: triangles by depth on a grid of samples, soft shadows, thin lines.
#pragma once

#include <vector>

#include "wunderlich/base/frame.hpp"
#include "wunderlich/picture/camera.hpp"
#include "wunderlich/picture/image.hpp"
#include "wunderlich/picture/style.hpp"

namespace wunderlich::picture {

/// What is drawn, by reference: the recorded frames, and the bodies with a pose for each.
struct Subject {
  const std::vector<Frame>& frames;
  const std::vector<Body>& bodies;
  const std::vector<FlatPattern>& strips;
};

/// What pictures of some frames have in common, so that a film does not jump.
struct Plan {
  std::vector<std::size_t> frames;  ///< indices
  std::vector<Fit> fits;            ///< one each
  Camera camera;
  double range = 1;  ///< of the field that colours the surface, in its unit
};

/// For the frames with these indices; the view is that of the last.
Plan plan(const Subject& subject, const Style& style, std::vector<std::size_t> frames);

/// The k-th of the planned pictures. The same bytes whatever the number of cores.
Image draw(const Subject& subject, const Style& style, const Plan& plan, std::size_t k);

/// The frame of `style`, or the last, by itself.
Image still(const Subject& subject, const Style& style);

}  // namespace wunderlich::picture
