#include "wunderlich/solver/chain_mesh_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/facet_pairs.hpp"

namespace wunderlich::solver {

using contact::Extent;
using contact::Gap;
using contact::PairEnergy;
using contact::PairKind;
using contact::PairPoints;
using contact::TriangleMesh;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kRim = 0.125;    // of the barrier's distance: how far a prism around a cylinder's end may stand out
constexpr double kNotFar = 0.25;  // of the width: what is nearer to a solid's box is looked at

const PairPoints& corners_of(const MeshProblem& problem, const MeshPoints& points, std::size_t solid,
                             std::size_t segment) {
  return points.facets[solid * (points.facets.size() / problem.solids.size()) + segment];
}

PairPoints points_of(const FacetPair& pair, const MeshProblem& problem, const MeshPoints& points) {
  return points_of(pair, corners_of(problem, points, pair.solid, pair.segment), *problem.solids[pair.solid].mesh);
}

/// Edges' lengths are those of the flat strip, which do not change.
Gap gap_of(const Ribbon& ribbon, const MeshProblem& problem, const FacetPair& pair, const PairPoints& x) {
  Gap gap{problem.distance, problem.thickness, 0};
  if (pair.kind == PairKind::edge_edge) {
    const bool rim = pair.corner[0] % 2 == pair.corner[1] % 2;
    const double own = rim ? ribbon.rest_length[pair.segment] : ribbon.width;
    gap.parallel = kParallel * own * own * (x[3] - x[2]).squaredNorm();
  }
  return gap;
}

/// Each end of a facet has two corners, which stand for half of it.
double weight_of(const Ribbon& ribbon, const MeshProblem& problem, const FacetPair& pair) {
  return 0.5 * problem.stiffness * ribbon.rest_length[pair.segment] * ribbon.width;
}

/// Around all corners, in space.
Extent box_around(const Ribbon& ribbon, const Chain& chain, const Kinematics& k) {
  Extent box{k.r.front(), k.r.front()};
  const double v = 0.5 * ribbon.width;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    for (std::size_t i = s; i < s + 2; ++i) {
      const Vec3 ruling = v * (k.frame[s].col(1) + chain.eta[i] * k.frame[s].col(2));
      box.add(k.r[i] - ruling);
      box.add(k.r[i] + ruling);
    }
  }
  return box;
}

/// All facets' corners in a solid's own frame.
void place_facets(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, const Pose& pose, PairPoints* facets) {
  const Mat3 to_own = pose.frame.conjugate().toRotationMatrix();
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Mat3 frame = to_own * k.frame[s];
    for (std::size_t c = 0; c < 4; ++c) {
      const double v = (c % 2 == 0 ? -0.5 : 0.5) * ribbon.width, eta = chain.eta[s + c / 2];
      facets[s][c] = to_own * (k.r[s + c / 2] - pose.position) + v * (frame.col(1) + eta * frame.col(2));
    }
  }
}

/// How a corner of a facet moves.
struct CornerLever {
  Vec3 arm;       ///< from the segment's far node [m]
  Vec3 slant[2];  ///< with eta at the segment's start and end [m]
};

CornerLever lever_of(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, std::size_t s, int corner) {
  const double v = (corner % 2 == 0 ? -0.5 : 0.5) * ribbon.width;
  const int end = corner / 2;
  const auto node = s + static_cast<std::size_t>(end);
  const Vec3 d2 = k.frame[s].col(1), d3 = k.frame[s].col(2);
  CornerLever lever{(v * chain.eta[node] - (end == 0 ? ribbon.rest_length[s] : 0)) * d3 + v * d2,
                    {Vec3::Zero(), Vec3::Zero()}};
  if (geometry::eta_is_free(ribbon, static_cast<int>(node))) lever.slant[end] = v * d3;
  return lever;
}

/// Second derivative of a corner's place, with the force that is the gradient there.
void add_turning(const CornerLever& lever, const Vec3& force, math::Mat8& geometric) {
  geometric.block<3, 3>(3, 3) +=
      0.5 * (force * lever.arm.transpose() + lever.arm * force.transpose()) - force.dot(lever.arm) * Mat3::Identity();
  for (int c = 0; c < 2; ++c) {
    const Vec3 part = lever.slant[c].cross(force);
    geometric.block<3, 1>(3, 6 + c) += part;
    geometric.block<1, 3>(6 + c, 3) += part.transpose();
  }
}

/// The sweep's term of a segment; made where there is none.
math::SurfaceTerm& term_of(std::size_t segment, math::ChainSystem& system) {
  const auto node = static_cast<int>(segment);
  const auto is_later = [&](const math::SurfaceTerm& term) { return term.node > node; };
  const auto place = std::partition_point(system.surfaces.begin(), system.surfaces.end(), is_later);
  if (place != system.surfaces.end() && place->node == node) return *place;
  math::SurfaceTerm term;
  term.node = node;
  return *system.surfaces.insert(place, term);
}

}  // namespace

bool is_mesh(const contact::Shape& shape) {
  return std::holds_alternative<contact::Box>(shape) || std::holds_alternative<contact::Polyhedron>(shape);
}

void stand(const Pose& pose, MeshSolid& solid) {
  solid.pose = pose;
  const Mat3 frame = pose.frame.toRotationMatrix();
  const Vec3 middle = pose.position + frame * (0.5 * (solid.mesh->whole.low + solid.mesh->whole.high));
  const Vec3 half = frame.cwiseAbs() * (0.5 * (solid.mesh->whole.high - solid.mesh->whole.low));
  solid.extent = {middle - half, middle + half};
}

void place_meshes(const constraint::Surroundings& surroundings, double t, double stiffness, MeshProblem& problem) {
  problem.distance = surroundings.contact.distance;
  problem.thickness = surroundings.contact.thickness;
  problem.stiffness = stiffness;
  std::size_t count = 0;
  for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
    const auto place = [&](const Vec4& sizes, const auto& make) {
      if (count == problem.solids.size()) problem.solids.emplace_back();
      MeshSolid& solid = problem.solids[count++];
      solid.friction = obstacle.friction;
      if (!solid.mesh || solid.made_for != sizes) solid.mesh = make();
      solid.made_for = sizes;
      stand(constraint::pose_at(obstacle.motion, t), solid);
    };
    if (const auto* polyhedron = std::get_if<contact::Polyhedron>(&obstacle.shape)) {
      place(Vec4::Zero(), [&] { return polyhedron->mesh; });
    } else if (const auto* box = std::get_if<contact::Box>(&obstacle.shape)) {
      place({box->half_size.x(), box->half_size.y(), box->half_size.z(), 0},
            [&] { return std::make_shared<const TriangleMesh>(contact::mesh_of(*box)); });
    } else if (const auto* cylinder = std::get_if<contact::Cylinder>(&obstacle.shape)) {
      if (!std::isfinite(cylinder->half_length)) continue;
      const double beyond = kRim * problem.distance;
      for (const int side : {-1, 1}) {
        place({cylinder->radius, cylinder->half_length, static_cast<double>(side), beyond},
              [&] { return std::make_shared<const TriangleMesh>(contact::end_of(*cylinder, side, beyond)); });
      }
    }
  }
  problem.solids.resize(count);
}

void find_mesh_pairs(const Ribbon& ribbon, const MeshProblem& problem, const Chain& chain, const Kinematics& k,
                     MeshPoints& points) {
  const std::size_t n = ribbon.rest_length.size();
  points.facets.resize(problem.solids.size() * n);
  points.placed.assign(problem.solids.size(), 0);
  points.extents.clear();
  points.pairs.clear();
  points.beyond = std::numeric_limits<double>::infinity();
  if (problem.solids.empty()) return;
  points.strip = box_around(ribbon, chain, k);
  const double far = problem.thickness + problem.distance;
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    const MeshSolid& solid = problem.solids[i];
    points.extents.push_back(solid.extent);
    const double away = apart(points.strip, solid.extent);
    if (away > far + kNotFar * ribbon.width) {
      points.beyond = std::min(points.beyond, away);
      continue;
    }
    points.placed[i] = 1;
    PairPoints* const facets = points.facets.data() + i * n;
    place_facets(ribbon, chain, k, solid.pose, facets);
    gather(n, points.search, [&](std::size_t s) {
      const double least = apart(box_of(facets[s]), solid.mesh->whole);
      points.beyond = std::min(points.beyond, std::max(far, least));
      return !(least > far);
    });
    const auto box = [&](const FacetPart& part) {
      Extent extent = box_of(part, facets[part.segment]);
      extent.widen(far);
      return extent;
    };
    match_all(i, *solid.mesh, points.search, box, [&](FacetPair& pair) {
      pair.distance = contact::pair_distance(pair.kind, points_of(pair, facets[pair.segment], *solid.mesh));
      if (!(pair.distance >= far)) points.pairs.push_back(pair);
    });
  }
}

double mesh_energy(const Ribbon& ribbon, const MeshProblem& problem, const MeshPoints& points) {
  double sum = 0;
  for (const FacetPair& pair : points.pairs) {
    const PairPoints x = points_of(pair, problem, points);
    sum += weight_of(ribbon, problem, pair) * contact::pair_value(pair.kind, x, gap_of(ribbon, problem, pair, x));
  }
  return sum;
}

double mesh_distance(const MeshProblem& problem, const MeshPoints& points) {
  if (problem.solids.empty()) return std::numeric_limits<double>::infinity();
  double least = points.beyond;
  for (const FacetPair& pair : points.pairs) least = std::min(least, pair.distance);
  return least - problem.thickness;
}

double mesh_work(const Ribbon& ribbon, const MeshProblem& from, const MeshPoints& before, const MeshProblem& to,
                 const MeshPoints& after, double late) {
  double work = 0;
  const auto add = [&](const MeshProblem& problem, const MeshPoints& points, double share) {
    for (const FacetPair& pair : points.pairs) {
      const Pose &pose0 = from.solids[pair.solid].pose, &pose1 = to.solids[pair.solid].pose;
      if (pose0.position == pose1.position && pose0.frame.coeffs() == pose1.frame.coeffs()) continue;
      const PairPoints x = points_of(pair, problem, points);
      const PairEnergy energy = contact::pair_energy(pair.kind, x, gap_of(ribbon, problem, pair, x));
      const double weight = share * weight_of(ribbon, problem, pair);
      for (int k = 0; k < 4; ++k) {  // the energy changes with the solid's vertices
        const auto point = static_cast<std::size_t>(k);
        if (pair.vertex[point] < 0) continue;
        const Vec3 way = pose1.position + pose1.frame * x[point] - pose0.position - pose0.frame * x[point];
        work += weight * way.dot(problem.solids[pair.solid].pose.frame * Vec3(energy.gradient.segment<3>(3 * k)));
      }
    }
  };
  add(from, before, 1 - late);
  add(to, after, late);
  return work;
}

void add_mesh_friction(const Ribbon& ribbon, const MeshProblem& from, const MeshPoints& points, const Chain& chain,
                       const Kinematics& k, const MeshProblem& to, std::vector<Friction>& friction) {
  for (const FacetPair& pair : points.pairs) {
    const MeshSolid &solid0 = from.solids[pair.solid], &solid1 = to.solids[pair.solid];
    if (solid1.friction == 0) continue;
    const PairPoints x = points_of(pair, from, points);
    const PairEnergy energy = contact::pair_energy(pair.kind, x, gap_of(ribbon, from, pair, x));
    const contact::PairNearest nearest = contact::pair_nearest(pair.kind, x);
    const std::size_t s = pair.segment;
    Friction rub{s, 0, 0, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0};
    Vec3 force = Vec3::Zero(), at = Vec3::Zero();
    for (std::size_t point = 0; point < 4; ++point) {
      if (pair.corner[point] < 0) continue;
      const int corner = pair.corner[point];
      const double share = std::abs(nearest.weights[static_cast<int>(point)]);
      const double v = (corner % 2 == 0 ? -0.5 : 0.5) * ribbon.width;
      const double behind = corner < 2 ? -ribbon.rest_length[s] : 0;
      rub.along += share * (behind + v * chain.eta[s + static_cast<std::size_t>(corner / 2)]);
      rub.across += share * v;
      at += share * x[point];
      force -= energy.gradient.segment<3>(3 * static_cast<int>(point));
    }
    const double size = force.norm();
    if (!(size > 0)) continue;
    rub.carried = solid1.pose.position + solid1.pose.frame * at - solid0.pose.position - solid0.pose.frame * at;
    rub.from = k.r[s + 1] + rub.along * k.frame[s].col(2) + rub.across * k.frame[s].col(1) + rub.carried;
    rub.normal = solid1.pose.frame * (force / size);
    rub.force = solid1.friction * weight_of(ribbon, from, pair) * size;
    friction.push_back(rub);
  }
  std::sort(friction.begin(), friction.end(),
            [](const Friction& a, const Friction& b) { return a.segment > b.segment; });
}

void add_mesh_contact(const Ribbon& ribbon, const MeshProblem& problem, const Chain& chain, const Kinematics& k,
                      const MeshPoints& points, math::ChainSystem& system) {
  for (const FacetPair& pair : points.pairs) {
    const std::size_t s = pair.segment;
    const PairPoints x = points_of(pair, problem, points);
    const PairEnergy energy = contact::pair_energy(pair.kind, x, gap_of(ribbon, problem, pair, x));
    const double weight = weight_of(ribbon, problem, pair);
    const Mat3 to_space = problem.solids[pair.solid].pose.frame.toRotationMatrix();
    math::SurfaceTerm& term = term_of(s, system);
    Eigen::Matrix<double, 12, 8> move = Eigen::Matrix<double, 12, 8>::Zero();
    for (int i = 0; i < 4; ++i) {
      const int corner = pair.corner[static_cast<std::size_t>(i)];
      if (corner < 0) continue;
      const CornerLever lever = lever_of(ribbon, chain, k, s, corner);
      Eigen::Matrix<double, 3, 8> in_space;
      in_space << Mat3::Identity(), -math::skew(lever.arm), lever.slant[0], lever.slant[1];
      move.middleRows<3>(3 * i) = to_space.transpose() * in_space;
      add_turning(lever, weight * (to_space * energy.gradient.segment<3>(3 * i)), term.geometric);
    }
    term.gradient += weight * (move.transpose() * energy.gradient);
    const math::Vec8 along = move.transpose() * energy.along;
    const math::Mat8 stiff = weight * energy.second * along * along.transpose();
    term.hessian += stiff;
    term.geometric += weight * (move.transpose() * energy.hessian * move) - stiff;
  }
}

}  // namespace wunderlich::solver
