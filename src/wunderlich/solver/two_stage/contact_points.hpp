/// Where the reconstructed surface meets solids: fixed material points S(u, v) with the solid's normal.
/// @eq Shen2015:6.3
#pragma once

#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/two_stage/contact_rows.hpp"

namespace wunderlich::solver::two_stage {

/// A point that a solid pushes, in one step.
struct Touch {
  Place place;
  std::size_t solid = 0;
  bool fast = false;           ///< may leap over the solid in this step
  double eta_start = 0;        ///< ruling at the step's start: friction acts on what is fixed to the material
  Vec3 from = Vec3::Zero();    ///< where it would be had it gone with the solid [m]
  Vec3 normal = Vec3::Zero();  ///< of the solid, outward
  double gap = 0;              ///< beyond thickness and margin; of a plane that keeps the solid behind it [m]
  double allowed = 0;          ///< gap that may be left: what was inside at the step's start comes out slowly [m]
  double push = 0;             ///< lambda_n so far [N]
  Vec3 drag = Vec3::Zero();    ///< lambda_t so far, in the plane tangent to the solid [N]
};

/// What a look at all points found.
struct Nearest {
  double gap = 0;       ///< smallest, beyond thickness and margin [m]
  double distance = 0;  ///< smallest, beyond the thickness [m]
};

/// The solids at both ends of a substep, and no touches.
void set_solids(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, double t0, double t1,
                Workspace& work);

/// Looks at all points of a shape and adds those that are inside a solid to the touches: of a facet, which is flat, the
/// deepest and the outermost, since others say the same.
Nearest find_touches(const geometry::Ribbon& ribbon, const geometry::State& shape, double tolerance, Workspace& work);

/// Normal and gap of a touch where the strip now is.
void refresh_touch(const geometry::State& shape, const Workspace& work, Touch& touch);

}  // namespace wunderlich::solver::two_stage
