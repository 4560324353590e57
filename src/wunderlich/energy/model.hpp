/// Which elastic energy: the choice a scene makes.
#pragma once

namespace wunderlich::energy {

enum class Elastic {
  wunderlich,   ///< exact width integral, atanh(x)/x              @eq Shen2015:3
  truncated,    ///< its Taylor series to `taylor_order`           @eq Shen2015:4
  sadowsky,     ///< narrow limit, order 0
};

enum class StrainMeasure {
  logarithm,    ///< rotation vector over the hinge length: exact for the ring, monotone in the fold angle
  printed,      ///< (2/l) vec(conj(q^s) q^(s+1)), as the paper prints it
};

struct Model {
  Elastic elastic = Elastic::wunderlich;
  int taylor_order = 5;
  StrainMeasure strain = StrainMeasure::logarithm;
};

}  // namespace wunderlich::energy
