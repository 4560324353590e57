/// Where parts of the strip meet one another or solids of triangles: corners and triangles, edges and edges. Distances
/// of such pairs have no sign; which side is which is known from the step's start, where nothing touches, and from the
/// way since then. Thin round solids are met in the same way, by their axis or center, which is a radius away.
#pragma once

#include "wunderlich/solver/facet_pairs.hpp"
#include "wunderlich/solver/self_contact.hpp"
#include "wunderlich/solver/two_stage/contact_touch.hpp"

namespace wunderlich::solver::two_stage {

/// A round solid as all that is within a radius of a straight piece or a point, and the facets that meet it so. Of a
/// cylinder with ends it is the largest such part inside.
struct Core {
  double radius = 0;         ///< [m]
  int count = 0;             ///< of its ends: 2, 1 for a sphere, 0 where there is none
  std::array<Vec3, 2> ends;  ///< in the solid's own frame [m]
  std::vector<char> coarse;  ///< (segments) facets that would bulge into it between the points of the grid
};

/// The strip's corners at both ends of a substep, and the buffers of the search for what they meet.
struct Corners {
  std::vector<Place> place;                                ///< corner 2i + side of node i
  std::vector<Vec3> before, now;                           ///< [m]
  std::vector<double> eta_before;                          ///< rulings at the start, one a corner
  SelfContact self;                                        ///< not active where the strip does not feel itself
  bool has_meshes = false;                                 ///< are there solids of triangles
  bool has_cores = false;                                  ///< do facets meet cores
  std::vector<Core> cores;                                 ///< (solids)
  std::vector<contact::PairPoints> facets_before, facets;  ///< in the frame of a solid
  SelfSearch self_search;
  PairSearch mesh_search;
  double margin = 0;  ///< that pairs keep beyond the thickness [m]
  double width = 0;   ///< of the strip [m]
};

/// What the strip's corners may meet in a substep that work.before began.
void set_pairs(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, Workspace& work);

/// Looks at all pairs that come near on the way from work.before to a shape.
void find_pairs(const geometry::State& shape, double tolerance, Nearest& nearest, Workspace& work);

/// Weights, normal and gap of a touch in the shape that was looked at last.
void refresh_pair(const Workspace& work, Touch& touch);

}  // namespace wunderlich::solver::two_stage
