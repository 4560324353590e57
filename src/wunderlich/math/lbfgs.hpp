/// Limited-memory BFGS: the direction -H g from the last few changes of position and gradient.
#pragma once

#include <vector>

namespace wunderlich::math {

struct Lbfgs {
  int memory = 6;
  int stored = 0, newest = -1;
  std::vector<std::vector<double>> position, gradient;  ///< (memory) changes
  std::vector<double> inverse_product;                  ///< (memory) 1/(s . y)
  std::vector<double> share;                            ///< (memory) buffer

  /// Forgets everything; allocates only to grow.
  void reset(std::size_t size);
  /// Keeps a pair unless its curvature s . y is not positive enough to keep H positive.
  void push(const std::vector<double>& position_change, const std::vector<double>& gradient_change);
  /// direction = -H gradient; the first H is `scale` times the identity, later ones s.y/y.y of the newest pair.
  void direction(const std::vector<double>& gradient_now, double scale, std::vector<double>& out);
};

}  // namespace wunderlich::math
