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
  double along, across;         ///< of the point from the segment's far node, along d3 and d2 [m]
  Vec3 from;                    ///< where it would be had it gone with the solid [m]
  Vec3 carried = Vec3::Zero();  ///< the solid's way there in the step [m]
  Vec3 normal;
  double force;  ///< coefficient times normal force [N]
};

/// Solids at one time, and the points of each segment that feel them.
struct ContactProblem {
  struct Solid {
    contact::Shape shape;
    Pose pose;
    double friction;  ///< Coulomb's coefficient
    double sag = 0;   ///< how much nearer than its ends a chord can be, over its length's square: 1/8 radius [1/m]
  };
  std::vector<Solid> solids;       ///< round ones and planes
  MeshProblem meshes;              ///< those of triangles
  double distance = 0;             ///< at which forces begin [m]
  double thickness = 0;            ///< that stays between surface and solid [m]
  double stiffness = 0;            ///< of the barrier, per area [N/m^3]
  double width = 0;                ///< of the strip [m]
  int along = 1;                   ///< cells of points along a segment
  int across = 1;                  ///< and across it
  std::vector<Friction> friction;  ///< one a point that rubs, segments in decreasing order
  double slip = 0;                 ///< way in a step from which on friction has its full force [m]
  bool empty() const { return solids.empty() && meshes.solids.empty(); }
};

/// One facet beside one solid, in the solid's own frame: where its points are, and how near any of them can be.
struct ContactFacet {
  Vec3 start, along;  ///< first node, and from it to the second one [m]
  Vec3 across[2];     ///< from a node to the point at v = 1 on its ruling
  double length, eta[2];
  double sag[2];      ///< the solid's, over the squares of cells along and of cells across over the width
  double kept;        ///< no point keeps more [m]
  Vec3 normal;        ///< of the solid, where it is nearest to the facet's middle
  double gap;         ///< distance of the middle beyond that [m]
  double least;       ///< none of its points has a smaller gap [m]
  bool near;          ///< its points are looked at
  std::size_t first;  ///< of its points, if so
  Vec3 middle() const { return start + 0.5 * along; }
  Vec3 at(double f, double v) const { return start + f * along + v * ((1 - f) * across[0] + f * across[1]); }
  double eta_at(double f) const { return (1 - f) * eta[0] + f * eta[1]; }
  double length_at(double v) const { return length + v * (eta[1] - eta[0]); }
  /// What a point keeps so that the facet between it and its neighbours stays out [m].
  double margin(double f, double v) const {
    const double lean = eta_at(f), side = length_at(v);
    return sag[0] * side * side + sag[1] * (1 + lean * lean);
  }
};

/// A point that feels a solid.
struct Touch {
  std::size_t facet, point;  ///< indices
  double share, v;           ///< f, and across the strip [m]
  double area;               ///< that it stands for [m^2]
  double log;                ///< of its gap over the barrier's distance
};

/// A strip beside all solids.
struct ContactPoints {
  std::vector<ContactFacet> facets;  ///< of the first segment with each solid, of the second one ...
  std::vector<Vec3> at, normal;      ///< of near facets' points, in the solids' own frames
  std::vector<double> gap;           ///< distance beyond thickness and margin [m]
  std::vector<Touch> touches;        ///< in the facets' order
  MeshPoints meshes;                 ///< beside solids of triangles; the others are those of round ones and planes
  bool settled = true;               ///< false: far from the minimum, where friction's Hessian is that of a majorant
  void clear() { facets.clear(), at.clear(), normal.clear(), gap.clear(), touches.clear(), meshes.pairs.clear(); }
};

/// The surroundings' solids at a time, with points dense enough that no solid's curve cuts a facet between them.
void place_solids(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, double t,
                  ContactProblem& problem);

/// All points near solids; nothing else of the chain is looked at by what follows.
void find_points(const geometry::Ribbon& ribbon, const ContactProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics, ContactPoints& points);

/// Energy of the barrier [J]; infinite where a point touches.
double contact_energy(const geometry::Ribbon& ribbon, const ContactProblem& problem, const ContactPoints& points);

/// May the points go from one place to the other in straight lines? Not if one would enter a solid (they are convex) or
/// lose more than nine tenths of its gap within the barrier's distance. Buffers of `to` are of use.
bool may_go(const ContactProblem& problem, const ContactPoints& from, ContactPoints& to);

/// Distance of the facets to a solid beyond the thickness [m], a bound from below: what may be nearer between their
/// points is taken off. Infinite without solids.
double smallest_distance(const ContactProblem& problem, const ContactPoints& points);

/// Points that feel a solid.
int contact_count(const ContactPoints& points);

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

/// Work of the solids on the strip by friction, as far as it is not lost in sliding [J].
double friction_work(const ContactProblem& problem, const geometry::Kinematics& kinematics);

/// Derivatives of barrier and friction, as terms of the sweep. `points` are those of the chain.
void add_contact(const geometry::Ribbon& ribbon, const ContactProblem& problem, const geometry::Chain& chain,
                 const geometry::Kinematics& kinematics, const ContactPoints& points, math::ChainSystem& system);

}  // namespace wunderlich::solver
