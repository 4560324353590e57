/// Contact of strips with themselves and with one another: corners against facets and edges against edges, kept apart
/// by a barrier.
///
/// Corners are the ends of the rulings, r + v (d2 + eta d3) with v = -w/2, w/2: corner 2i + side of node i, those of a
/// further strip after those of the strips before it. Between them facets are flat, two triangles each, and edges
/// straight, so that pairs of these are all there is to look at.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/contact/near_pairs.hpp"
#include "wunderlich/contact/pair.hpp"
#include "wunderlich/solver/corner_sums.hpp"

namespace wunderlich::solver {

/// The surface of one strip among others.
struct SelfSurface {
  int first_corner = 0;
  int segments = 0;
  double period = 0;     ///< loops: their length [m]
  double flip = 1;       ///< loops: -1 where the seam turns the surface over
  double open_seam = 0;  ///< length about the seam of a loop that is not closed yet, whose sides do not touch [m]
};

/// Two parts that rub during a step: one slides along the other in the plane tangent where the step began, against a
/// force that was there. Points go with the material, their rulings are those of the step's start.   @eq Li2020:14
struct SelfRub {
  std::array<int, 4> corner;
  Vec4 weights;  ///< of the corners: their sum is the way from the second part to the first
  Vec3 normal;
  Vec3 from;     ///< that way when the step began [m]
  double force;  ///< coefficient times normal force [N]
};

/// How strips feel themselves and one another during one minimisation.
struct SelfContact {
  double reach = 0;      ///< gap at which forces begin [m]; 0: they do not
  double thickness = 0;  ///< that stays between two parts of the middle surfaces [m]
  double stiffness = 0;  ///< of a pair's barrier [N/m]
  double friction = 0;   ///< Coulomb's coefficient
  std::vector<SelfRub> rubs;
  double slip = 0;  ///< way in a step from which on friction has its full force [m]
  std::vector<SelfSurface> surfaces;
  std::vector<Vec3> flat;  ///< corners in the flat pattern of their own strip, which tells who is whose neighbour
  bool active() const { return reach > 0; }
};

/// Two parts of the surface, by their corners.
struct SelfPair {
  contact::PairKind kind;
  std::array<int, 4> corner;
};

/// Where the corners are, and the pairs within reach.
struct SelfContacts {
  std::vector<Vec3> corners;   ///< (2 (segments + 1)) of each strip
  std::vector<Vec3> material;  ///< where their points went that were corners when the step began; where something rubs
  std::vector<SelfPair> pairs;
};

/// Buffers of the search.
struct SelfSearch {
  std::vector<int> corner_parts;  ///< the parts that boxes are drawn about, by their corners
  std::vector<std::array<int, 2>> edge_parts;
  std::vector<std::array<int, 3>> triangle_parts;
  std::vector<contact::Extent> corners, edges, triangles;
  contact::ExtentTree corner_tree, edge_tree, triangle_tree;
  std::vector<contact::Near> near;
  std::vector<SelfPair> candidates;
};

/// The surroundings' contact, with forces from `reach` on, for a strip whose flat pattern has these rulings. `closed`:
/// is the loop closed yet?
void place_self(const geometry::Ribbon& loop, const constraint::Surroundings& surroundings, double reach, bool closed,
                const std::vector<double>& eta, SelfContact& problem);

/// A further strip beside those that are there. What they do to one another is as stiff as the stiffer of them.
void place_beside(const SelfContact& other, SelfContact& all);

/// All pairs of parts that may come within reach while corners go straight from one place to another, but for
/// neighbours, into search.candidates.
void find_candidates(const SelfContact& problem, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                     SelfSearch& search);

/// Corners and pairs of strips at rest.
void find_pairs(std::span<const StripPlace> strips, const SelfContact& problem, SelfSearch& search,
                SelfContacts& contacts);

/// The same at the end of a way, on which corners go straight. False if something would pass through something, or if a
/// gap would lose more than nine tenths of what it was within reach; then `to` is not complete.
bool travel(std::span<const StripPlace> strips, const SelfContact& problem, const SelfContacts& from,
            SelfSearch& search, SelfContacts& to);

/// Where the points of the material are that were corners when the step began.
void find_material(std::span<const StripPlace> strips, const SelfContact& problem, std::vector<Vec3>& material);

/// How the barrier of a pair acts.
contact::Gap gap_of(const SelfContact& problem, const SelfPair& pair);

/// Energy of the barrier [J].
double self_energy(const SelfContact& problem, const SelfContacts& contacts);

/// Adds its derivatives: to the strips' own systems, and to `between` what points of two strips do to each other.
void add_self_contact(std::span<const StripPlace> strips, const SelfContact& problem, const SelfContacts& contacts,
                      std::span<math::ChainSystem* const> systems, std::vector<math::ChainCoupling>& between);

/// Friction in a step of length h: of the pairs at its start.
void set_friction(const SelfContacts& contacts, double h, SelfContact& problem);

/// What is minimised for it: force times way, rounded off where the way is short [J].
double friction_value(const SelfContact& problem, const SelfContacts& contacts);

/// Adds its derivatives; unless it is `settled` with the Hessian of a majorant.
void add_self_friction(std::span<const StripPlace> strips, const SelfContact& problem, const SelfContacts& contacts,
                       bool settled, std::span<math::ChainSystem* const> systems,
                       std::vector<math::ChainCoupling>& between);

/// Smallest distance of parts that are not neighbours, beyond the thickness [m]; `reach` where none is nearer.
double smallest_distance(const SelfContact& problem, const SelfContacts& contacts);

/// How many edges go through facets that are not their neighbours'. A barrier does not see what is so from the start.
int count_crossings(const SelfContact& problem, const SelfContacts& contacts, SelfSearch& search);

}  // namespace wunderlich::solver
