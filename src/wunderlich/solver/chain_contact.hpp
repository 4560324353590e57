/// Contact of a chain with solids: points of its surface are kept out by a barrier that begins at a small distance.
///
/// A point lies at a share f of its segment and at v across it, r + (f - 1) l d3 + v (d2 + eta d3) from the segment's
/// far node, eta linear between the rulings at both ends.   @eq Shen2015:1 @eq Li2020:4
#pragma once

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/chain_sweep.hpp"
#include "wunderlich/solver/chain_mesh_contact.hpp"

namespace wunderlich::solver {

/// Coulomb's friction on one point during a step: it may go with the solid, and slides against a force that was there
/// when the step began. Its ruling is that of the step's start.   @eq Li2020:14
struct Friction {
  std::size_t segment;
  double along, across;  ///< of the point from the segment's far node, along d3 and d2 [m]
  Vec3 from;             ///< where it would be had it gone with the solid [m]
  Vec3 normal;
  double force;  ///< coefficient times normal force [N]
};

/// Solids at one time, and the points of each segment that feel them.
struct ContactProblem {
  struct Solid {
    contact::Shape shape;
    Pose pose;
    double friction;  ///< Coulomb's coefficient
  };
  std::vector<Solid> solids;       ///< round ones and planes
  MeshProblem meshes;              ///< those of triangles
  double distance = 0;             ///< at which forces begin [m]
  double thickness = 0;            ///< that stays between surface and solid [m]
  double margin = 0;               ///< that points keep so that facets between them stay out [m]
  double stiffness = 0;            ///< of the barrier, per area [N/m^3]
  int along = 1;                   ///< cells of points along a segment
  int across = 1;                  ///< and across it
  std::vector<Friction> friction;  ///< one a point that rubs, segments in decreasing order
  double slip = 0;                 ///< way in a step from which on friction has its full force [m]
  bool empty() const { return solids.empty() && meshes.solids.empty(); }
};

/// One point of the strip beside one solid, in the solid's own frame.
struct ContactPoint {
  Vec3 at;       ///< [m]
  Vec3 normal;   ///< of the solid there, outward
  double gap;    ///< distance beyond thickness and margin; of far points a bound from below, with its gradient [m]
  Mat3 hessian;  ///< of the distance
};

/// A strip beside all solids.
struct ContactPoints {
  std::vector<ContactPoint> all;  ///< beside round ones and planes
  MeshPoints meshes;
  void clear() { all.clear(), meshes.pairs.clear(); }
};

/// The surroundings' solids at a time, with points dense enough that no solid's curve cuts a facet between them.
void place_solids(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, double t,
                  ContactProblem& problem);

/// All points of all solids; nothing else of the chain is looked at by what follows.
void find_points(const geometry::Ribbon& ribbon, const ContactProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics, ContactPoints& points);

/// Energy of the barrier [J]; infinite where a point touches.
double contact_energy(const geometry::Ribbon& ribbon, const ContactProblem& problem, const ContactPoints& points);

/// May the points go from one place to the other in straight lines? Not if one would enter a solid (they are convex) or
/// lose more than nine tenths of its gap within the barrier's distance. Buffers of `to` are of use.
bool may_go(const ContactProblem& problem, const ContactPoints& from, ContactPoints& to);

/// Distance of the nearest point to a solid beyond the thickness [m]; infinite without solids.
double smallest_distance(const ContactProblem& problem, const ContactPoints& points);

/// Points that feel a solid.
int contact_count(const ContactProblem& problem, const ContactPoints& points);

/// Work that moving solids do on the strip when they go from one place to the other while the strip's points are
/// `before`, then `after`: with the force before in the share 1 - `late`, after in the share `late` [J].
double solid_work(const geometry::Ribbon& ribbon, const ContactProblem& from, const ContactPoints& before,
                  const ContactProblem& to, const ContactPoints& after, double late);

/// Friction in a step of length h: of the points as they are at its start, where the solids are as in `from`.
void set_friction(const geometry::Ribbon& ribbon, const ContactProblem& from, const ContactPoints& points,
                  const geometry::Chain& chain, const geometry::Kinematics& kinematics, double h,
                  ContactProblem& problem);

/// What is minimised for it: force times way, rounded off where the way is short [J].
double friction_value(const ContactProblem& problem, const geometry::Kinematics& kinematics);

/// Derivatives of barrier and friction, as terms of the sweep. `points` are those of the chain.
void add_contact(const geometry::Ribbon& ribbon, const ContactProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics, const ContactPoints& points, math::ChainSystem& system);

}  // namespace wunderlich::solver
