/// Solids in a rod's way: points of the strip that its sections span are kept out by a barrier.
#pragma once

#include <vector>

#include "wunderlich/baseline/rod/frames.hpp"
#include "wunderlich/constraint/support.hpp"

namespace wunderlich::baseline::rod {

/// Solids at one time, and the grid of points on each edge: x + v m2, x along the edge, |v| <= w/2.   @eq Li2020:4
struct Solids {
  struct Solid {
    contact::Shape shape;
    Pose pose;
  };
  std::vector<Solid> solids;
  double distance = 0;   ///< at which forces begin [m]
  double kept = 0;       ///< gap that stays: thickness, and room for what is between the points [m]
  double stiffness = 0;  ///< of the barrier, per area [N/m^3]
  int along = 1, across = 1;
};

/// Stiffness and points are chosen as the ribbon's are.
Solids solids_at(const Rod& rod, const constraint::Surroundings& surroundings, double time);

using Vec7 = Eigen::Matrix<double, 7, 1>;
using Mat7 = Eigen::Matrix<double, 7, 7>;
/// Of the seven coordinates from an edge's first node on.
struct TouchTerms {
  Vec7 gradient;
  Mat7 hessian;
};

/// Energy of the barrier at the points of an edge [J]; infinite where one is inside. Adds derivatives unless null.
double barrier_energy(const Rod& rod, const Solids& solids, const State& state, std::size_t edge, TouchTerms* terms);

/// Smallest distance of any point to a solid's surface, less the thickness [m]; infinite without solids.
double clearance(const Rod& rod, const constraint::Surroundings& surroundings, const State& state);

}  // namespace wunderlich::baseline::rod
