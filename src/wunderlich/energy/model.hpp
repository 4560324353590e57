/// Which elastic energy: the choice a scene makes.
#pragma once

#include "wunderlich/geometry/state.hpp"

namespace wunderlich::energy {

enum class Elastic {
  wunderlich,  ///< exact width integral, atanh(x)/x              @eq Shen2015:3
  truncated,   ///< its Taylor series to `taylor_order`           @eq Shen2015:4
  sadowsky,    ///< narrow limit, order 0
};

using geometry::StrainMeasure;

/// Which elastic energy, of which strain; `taylor_order` is that of the truncated one.
struct Model {
  Elastic elastic = Elastic::wunderlich;
  int taylor_order = 5;
  StrainMeasure strain = StrainMeasure::logarithm;
};

}  // namespace wunderlich::energy
