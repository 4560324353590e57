/// Discrete elastic rod: a strip as a centreline with a turning cross-section, which may stretch, bend both ways and
/// twist.
///
/// The model of Bergou et al. 2008 with the time-parallel reference frames of 2010. Index families are the ribbon's:
/// node i in [0, segments], edge j from node j to j + 1; a loop repeats its first node as node `segments`. Directions
/// are the ribbon's as well: m1 normal to the strip, m2 across it.
#pragma once

#include <vector>

#include "wunderlich/base/types.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/geometry/state.hpp"

namespace wunderlich::baseline::rod {

struct Stiffness {
  double stretch = 0;  ///< EA [N]
  double soft = 0;     ///< of bending about m2, as a strip does [N m^2]
  double hard = 0;     ///< of bending about m1, in the plane of the strip [N m^2]
  double twist = 0;    ///< GJ [N m^2]
};

/// Of a rectangular section: E w h^3/12, E h w^3/12, G w h^3/3 (1 - 0.63 h/w), E w h. SI units.   @eq Roark2002
Stiffness rectangle(double youngs_modulus, double poisson_ratio, double width, double thickness);

/// The same where the strip's bending stiffness D = E h^3/(12 (1 - nu^2)) is given instead of E.
Stiffness physical(const geometry::RibbonSpec& spec, double poisson_ratio, double thickness);

/// Hard, soft and twisting stiffness as 1e4 : 1 : 2, the soft one D w: what a rectangle with h = w/100 and nu = 0 has;
/// the stretching stiffness is that rectangle's.   @eq Shen2015:6.5
Stiffness paper_ratio(const geometry::RibbonSpec& spec);

/// How a node's bending is measured, which has a section on either side.
enum class Bending {
  averaged,  ///< by one curvature, in the mean of the two sections   @eq Bergou2010
  separate,  ///< by two curvatures, one in each section, whose energies are averaged. Where a strip twists by phi from
             ///< edge to edge, it then bends about m1 as well, and seems stiffer by hard phi^2/4.   @eq Bergou2008:2
};

/// The rod: constant through a run. Naturally straight and untwisted.
struct Rod {
  int segments = 0;
  geometry::Closure closure = geometry::Closure::open;
  int half_twists = 0;  ///< loops: turns of pi of the section about the tangent, from edge 0 round to edge 0
  double length = 0, width = 0;
  Stiffness stiffness;
  Bending bending = Bending::averaged;
  double area_density = 0;           ///< [kg/m^2]
  std::vector<double> rest_length;   ///< (segments) [m]
  std::vector<double> hinge_length;  ///< (segments + 1) that a node's bending stands for, 0 at the ends of an open rod
                                     ///< and at node 0 of a loop, whose hinge is the last node's [m]
  std::vector<double> node_mass;     ///< (segments + 1), a loop's seam mass at node 0 [kg]
  std::vector<double> edge_inertia;  ///< (segments) of turning about the tangent [kg m^2]

  bool is_loop() const { return closure == geometry::Closure::loop; }
  std::size_t edges() const { return rest_length.size(); }
  std::size_t nodes() const { return rest_length.size() + 1; }
};

Rod make_rod(const geometry::RibbonSpec& spec, const Stiffness& stiffness);

/// What moves.   @eq Bergou2010
struct State {
  double time = 0;
  std::vector<Vec3> x, v;                ///< (segments + 1) [m, m/s]
  std::vector<double> theta, theta_dot;  ///< (segments) of m1 from the reference direction [rad, rad/s]
  std::vector<Vec3> reference;           ///< (segments) unit, square to the edge
  std::vector<double> reference_twist;   ///< (segments + 1) turn from one edge's reference direction, carried to the
                                         ///< next edge, to that edge's own; counts whole turns [rad]
};

/// Along +x from the origin with m1 = +z, as the undeformed ribbon.
State straight_state(const Rod& rod);

/// A loop as a regular polygon in the plane z = 0, the turns of its section spread evenly.
State ring_state(const Rod& rod);

/// Positions, velocities and frames of a ribbon with as many segments; frames are turned to their edges by the smallest
/// rotation, and twist at a node is taken within half a turn.
State state_from(const Rod& rod, const geometry::State& ribbon_state);

}  // namespace wunderlich::baseline::rod
