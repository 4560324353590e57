#include "wunderlich/contact/travel.hpp"

#include <algorithm>

namespace wunderlich::contact {

namespace {

constexpr int kMostSteps = 1000;
constexpr double kEnough = 0.05;  // of the distance that may be lost; less is not worth another step

}  // namespace

double free_share(PairKind kind, const PairPoints& x0, const PairPoints& x1, double offset, double leave) {
  const double start = pair_distance(kind, x0) - offset;
  if (!(start > 0)) return 0;
  PairPoints way;
  for (std::size_t k = 0; k < 4; ++k) way[k] = x1[k] - x0[k];
  // What all have in common brings nothing nearer.
  const Vec3 common = 0.25 * (way[0] + way[1] + way[2] + way[3]);
  double size[4];
  for (std::size_t k = 0; k < 4; ++k) size[k] = (way[k] - common).norm();
  // Distance changes by no more than the ways of a point of either primitive.
  const double most = kind == PairKind::vertex_triangle ? size[0] + std::max({size[1], size[2], size[3]})
                                                        : std::max(size[0], size[1]) + std::max(size[2], size[3]);
  const double kept = leave * start, least = kEnough * (start - kept);
  double t = 0, distance = start;
  for (int step = 0; step < kMostSteps; ++step) {
    if (!(distance - kept < (1 - t) * most)) return 1;
    t += (distance - kept) / most;
    PairPoints x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = x0[k] + t * (way[k] - common);
    distance = pair_distance(kind, x) - offset;
    if (!(distance - kept > least)) return t;
  }
  return t;
}

}  // namespace wunderlich::contact
