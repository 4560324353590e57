/// One picture's worth of things, placed on a grid of samples. Internal to picture/.
#pragma once

#include <vector>

#include "wunderlich/picture/draw.hpp"
#include "wunderlich/picture/raster.hpp"
#include "wunderlich/picture/shadow.hpp"

namespace wunderlich::picture {

inline constexpr int fine = 4;  ///< samples a pixel, each way

/// A line in the picture, x, y in samples and 1/depth.
struct Stroke {
  Vec3 from, to;
  float half_width = 1;
  float opacity = 1;
};

struct Sheet {
  Projection projection;
  std::vector<Patch> patches;
  std::vector<Stroke> strokes;
  Shadow shadow;
  double floor = 0;           ///< where shadows fall, on the stage
  int width = 0, height = 0;  ///< [samples]
};

Sheet sheet_of(const Subject& subject, const Style& style, const Plan& plan, std::size_t k);

}  // namespace wunderlich::picture
