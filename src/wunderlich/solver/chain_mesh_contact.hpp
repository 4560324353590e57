/// Contact of a chain's facets with solids of triangles. A facet is plane: two triangles between the four points
/// r +- (w/2) (d2 + eta d3) at its ends. What can touch first is a corner of a facet at a triangle, a rim or a ruling
/// at a ridge, or a peak at a facet; each such pair that is near has a barrier. One facet moves with one pose and two
/// rulings, so that pairs are stage costs of the sweep.   @eq Shen2015:1 @eq Li2020:5
#pragma once

#include <memory>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/chain_sweep.hpp"
#include "wunderlich/solver/facet_pairs.hpp"

namespace wunderlich::solver {

struct Friction;

struct MeshSolid {
  std::shared_ptr<const contact::TriangleMesh> mesh;
  Vec4 made_for = Vec4::Zero();  ///< sizes of the box, or of the cylinder's end, that the mesh was made for
  Pose pose;
  contact::Extent extent;  ///< in space
  double friction = 0;     ///< Coulomb's coefficient
};

/// Solids of triangles at one time.
struct MeshProblem {
  std::vector<MeshSolid> solids;
  double distance = 0;   ///< at which forces begin [m]
  double thickness = 0;  ///< that stays between surface and solid [m]
  double stiffness = 0;  ///< of the barrier, per area [N/m^3]
};

/// A strip beside all solids of triangles.
struct MeshPoints {
  contact::Extent strip;                    ///< around all of the strip, in space
  std::vector<contact::Extent> extents;     ///< of the solids
  std::vector<char> placed;                 ///< which of them the strip is not far from; others have no facets
  std::vector<contact::PairPoints> facets;  ///< corners in the solid's own frame: all segments of the first solid, ...
  std::vector<FacetPair> pairs;             ///< nearer than thickness and distance
  double beyond = 0;                        ///< where there are none: what the distance is at least [m]
  PairSearch search;
};

/// Is a solid one of triangles?
bool is_mesh(const contact::Shape& shape);

/// Puts a solid, which has its mesh, where it is from now on.
void stand(const Pose& pose, MeshSolid& solid);

/// Those among the surroundings' solids at a time, and the flat ends of cylinders, whose rims reach between the points
/// that their sides are felt by. Meshes of boxes and ends are made once.
void place_meshes(const constraint::Surroundings& surroundings, double t, double stiffness, MeshProblem& problem);

/// Finds all pairs of facets and solids nearer than thickness and distance, and what else `points` holds.
void find_mesh_pairs(const geometry::Ribbon& ribbon, const MeshProblem& problem, const geometry::Chain& chain,
                     const geometry::Kinematics& kinematics, MeshPoints& points);

/// Energy of the barriers [J]; infinite where something touches.
double mesh_energy(const geometry::Ribbon& ribbon, const MeshProblem& problem, const MeshPoints& points);

/// May the facets' corners go from one place to the other in straight lines? Not if a pair would touch on the way, or
/// lose more than nine tenths of its gap within the barrier's distance, or if boxes around both go through each other
/// from far away. `search` is of use to the next one.
bool mesh_may_go(const MeshProblem& problem, const MeshPoints& from, const MeshPoints& to, PairSearch& search);

/// Smallest distance beyond the thickness [m]; where nothing is near a bound from below, infinite without solids.
double mesh_distance(const MeshProblem& problem, const MeshPoints& points);

/// Is some part of the strip in a solid? Barriers do not see that.
bool is_inside_mesh(const MeshProblem& problem, const MeshPoints& points);

/// Work of moving solids, as solid_work.
double mesh_work(const geometry::Ribbon& ribbon, const MeshProblem& from, const MeshPoints& before,
                 const MeshProblem& to, const MeshPoints& after, double late);

/// Adds the friction of pairs that press, as set_friction.
void add_mesh_friction(const geometry::Ribbon& ribbon, const MeshProblem& from, const MeshPoints& points,
                       const geometry::Chain& chain, const geometry::Kinematics& kinematics, const MeshProblem& to,
                       std::vector<Friction>& friction);

/// Derivatives of the barriers, as terms of the sweep.
void add_mesh_contact(const geometry::Ribbon& ribbon, const MeshProblem& problem, const geometry::Chain& chain,
                      const geometry::Kinematics& kinematics, const MeshPoints& points, math::ChainSystem& system);

}  // namespace wunderlich::solver
