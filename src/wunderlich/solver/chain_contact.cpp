#include "wunderlich/solver/chain_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/contact/barrier.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using contact::Barrier;
using contact::barrier;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kStiffness = 100;   // barrier over weight or bending: light contact, few iterations
constexpr double kLeastShare = 0.1;  // of a gap that one step of Newton's leaves
constexpr int kMostCells = 12;       // across a strip, and along a segment
constexpr double kSlipSpeed = 1e-3;  // below which friction is less than Coulomb's [m/s]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double smallest_radius(const contact::Shape& shape) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) return cylinder->radius;
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) return capsule->radius;
  return kInfinity;
}

/// Where a point is on its segment, and the area it stands for.
struct Station {
  double share;  ///< f
  double v;      ///< [m]
  double area;   ///< [m^2]
};

/// Trapezoidal: corners and rims are among the points.
Station station(const Ribbon& ribbon, const ContactProblem& problem, std::size_t segment, int i, int k) {
  const double f = static_cast<double>(i) / problem.along, g = static_cast<double>(k) / problem.across;
  const double ends = (i == 0 || i == problem.along ? 0.5 : 1) * (k == 0 || k == problem.across ? 0.5 : 1);
  const double cell = ribbon.rest_length[segment] * ribbon.width / (problem.along * problem.across);
  return {f, (g - 0.5) * ribbon.width, ends * cell};
}

/// From the segment's far node to the point.
Vec3 arm(const Ribbon& ribbon, const Chain& chain, const Kinematics& k, std::size_t s, const Station& at) {
  const double eta = (1 - at.share) * chain.eta[s] + at.share * chain.eta[s + 1];
  return ((at.share - 1) * ribbon.rest_length[s] + at.v * eta) * k.frame[s].col(2) + at.v * k.frame[s].col(1);
}

/// Calls visit(segment, station, index of the point) for every point of one solid, segments in decreasing order.
template <class Visit>
void visit_points(const Ribbon& ribbon, const ContactProblem& problem, std::size_t solid, const Visit& visit) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  const auto each = static_cast<std::size_t>((problem.along + 1) * (problem.across + 1));
  for (std::size_t s = n; s-- > 0;) {
    std::size_t index = (solid * n + s) * each;
    for (int i = 0; i <= problem.along; ++i) {
      for (int k = 0; k <= problem.across; ++k) visit(s, station(ribbon, problem, s, i, k), index++);
    }
  }
}

/// How a point moves with its facet.
struct Lever {
  Vec3 arm;       ///< from the segment's far node [m]
  Vec3 slant[2];  ///< with eta at the segment's start and end [m]
};

/// The force that the barrier's first derivative is, and both parts of the Hessian, of one point.
void add_point(const Lever& lever, const Vec3& normal, const Mat3& curvature, const Barrier& b,
               math::SurfaceTerm& term) {
  const Vec3& arm = lever.arm;
  Eigen::Matrix<double, 3, 8> move;
  move << Mat3::Identity(), -math::skew(arm), lever.slant[0], lever.slant[1];
  const math::Vec8 along = move.transpose() * normal;
  const Vec3 force = b.first * normal;
  term.gradient += b.first * along;
  term.hessian += b.second * along * along.transpose();
  term.geometric += b.first * move.transpose() * curvature * move;
  term.geometric.block<3, 3>(3, 3) +=
      0.5 * (force * arm.transpose() + arm * force.transpose()) - force.dot(arm) * Mat3::Identity();
  for (int c = 0; c < 2; ++c) {
    const Vec3 part = lever.slant[c].cross(force);
    term.geometric.block<3, 1>(3, 6 + c) += part;
    term.geometric.block<1, 3>(6 + c, 3) += part.transpose();
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

/// Way along the solid's surface and the point's arm.
struct Slide {
  Vec3 way, arm;
};

Slide slide_of(const Friction& friction, const Kinematics& k) {
  const Mat3& frame = k.frame[friction.segment];
  const Vec3 arm = friction.along * frame.col(2) + friction.across * frame.col(1);
  const Vec3 way = k.r[friction.segment + 1] + arm - friction.from;
  return {way - friction.normal.dot(way) * friction.normal, arm};
}

/// Force times way, smooth at rest.   @eq Li2020:14
void add_friction(const Friction& friction, double slip, const Slide& slide, math::SurfaceTerm& term) {
  const double way = slide.way.norm(), share = std::min(1.0, way / slip);
  // (2 share - share^2) / way and its derivative, both finite at rest
  const double pull = friction.force * (share < 1 ? (2 - share) / slip : 1 / way);
  const double more = friction.force * (share < 1 ? 2 * (1 - share) / slip : 0);
  const Mat3 tangent = Mat3::Identity() - friction.normal * friction.normal.transpose();
  Mat3 stiffness = pull * tangent;
  if (way > 0) stiffness += (more - pull) / (way * way) * slide.way * slide.way.transpose();
  Eigen::Matrix<double, 3, 6> move;
  move << Mat3::Identity(), -math::skew(slide.arm);
  const Vec3 force = pull * slide.way;
  term.gradient.head<6>() += move.transpose() * force;
  term.hessian.topLeftCorner<6, 6>() += move.transpose() * stiffness * move;
  term.geometric.block<3, 3>(3, 3) +=
      0.5 * (force * slide.arm.transpose() + slide.arm * force.transpose()) - force.dot(slide.arm) * Mat3::Identity();
}

}  // namespace

void place_solids(const Ribbon& ribbon, const constraint::Surroundings& surroundings, double t,
                  ContactProblem& problem) {
  problem.solids.clear();
  problem.friction.clear();
  double radius = kInfinity;
  for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
    if (is_mesh(obstacle.shape)) continue;
    problem.solids.push_back({obstacle.shape, constraint::pose_at(obstacle.motion, t), obstacle.friction});
    radius = std::min(radius, smallest_radius(obstacle.shape));
  }
  const double w = ribbon.width, d = surroundings.contact.distance;
  problem.distance = d;
  problem.thickness = surroundings.contact.thickness;
  const double load = ribbon.area_density * surroundings.gravity.norm();
  problem.stiffness = kStiffness * std::max(load, ribbon.bending_stiffness / (w * w * w)) / d;
  place_meshes(surroundings, t, problem.stiffness, problem.meshes);
  // Points that are c apart and c^2/(8 R) off a solid of radius R leave it room between them. Cells lean by up to 45
  // degrees, so that their diagonals' squares are up to four of their sides'. A quarter of the distance is for that.
  const double cell = std::sqrt(0.5 * radius * d);
  const auto cells = [&](double size) {
    return static_cast<int>(std::clamp(std::ceil(size / cell), 1.0, static_cast<double>(kMostCells)));
  };
  const double longest = *std::max_element(ribbon.rest_length.begin(), ribbon.rest_length.end());
  problem.across = cells(w);
  problem.along = cells(longest);
  const double side = std::max(w / problem.across, longest / problem.along);
  problem.margin = std::min(0.5 * side * side / radius, d);
}

void find_points(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const Kinematics& k,
                 ContactPoints& points) {
  const auto n = static_cast<std::size_t>(ribbon.segments);
  find_mesh_pairs(ribbon, problem.meshes, chain, k, points.meshes);
  points.all.resize(problem.solids.size() * n * static_cast<std::size_t>((problem.along + 1) * (problem.across + 1)));
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    const contact::Shape& shape = problem.solids[i].shape;
    const Pose& pose = problem.solids[i].pose;
    const Mat3 to_own = pose.frame.conjugate().toRotationMatrix();
    contact::Distance middle{0, Vec3::Zero(), Mat3::Zero()};  // of the segment under way
    Vec3 center = Vec3::Zero();
    const double kept = problem.thickness + problem.margin;
    const auto each = static_cast<std::size_t>((problem.along + 1) * (problem.across + 1));
    visit_points(ribbon, problem, i, [&](std::size_t s, const Station& at, std::size_t index) {
      if (index % each == 0) {  // its first point
        center = to_own * (0.5 * (k.r[s] + k.r[s + 1]) - pose.position);
        middle = contact::distance(shape, center);
      }
      const Vec3 local = to_own * (k.r[s + 1] + arm(ribbon, chain, k, s, at) - pose.position);
      // Distance to a convex solid lies above its tangent plane: what is far by that need not be looked at.
      const double least = middle.value + middle.normal.dot(local - center) - kept;
      if (least > problem.distance) {
        points.all[index] = {local, middle.normal, least, Mat3::Zero()};
        return;
      }
      const contact::Distance d = contact::distance(shape, local);
      points.all[index] = {local, d.normal, d.value - kept, d.hessian};
    });
  }
}

double contact_energy(const Ribbon& ribbon, const ContactProblem& problem, const ContactPoints& points) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    visit_points(ribbon, problem, i, [&](std::size_t, const Station& at, std::size_t index) {
      sum += at.area * barrier(points.all[index].gap, problem.distance).value;
    });
  }
  return problem.stiffness * sum + mesh_energy(ribbon, problem.meshes, points.meshes);
}

bool may_go(const ContactProblem& problem, const ContactPoints& from, ContactPoints& to) {
  for (std::size_t i = 0; i < from.all.size(); ++i) {
    const ContactPoint &a = from.all[i], &b = to.all[i];
    if (!(b.gap > 0 && b.gap >= kLeastShare * std::min(a.gap, problem.distance))) return false;
    // The distance to a convex solid is convex along the way: above its tangents at both ends.
    const Vec3 way = b.at - a.at;
    const double down = a.normal.dot(way), up = b.normal.dot(way);
    if (down >= 0 || up <= 0) continue;
    const double lowest = a.gap + down * (a.gap - b.gap + up) / (up - down);
    if (!(lowest > 0)) return false;
  }
  return mesh_may_go(problem.meshes, from.meshes, to.meshes, to.meshes.search);
}

double smallest_distance(const ContactProblem& problem, const ContactPoints& points) {
  double least = mesh_distance(problem.meshes, points.meshes);
  for (const ContactPoint& point : points.all) least = std::min(least, point.gap + problem.margin);
  return least;
}

int contact_count(const ContactProblem& problem, const ContactPoints& points) {
  const auto touches = [&](const ContactPoint& point) { return point.gap < problem.distance; };
  return static_cast<int>(std::count_if(points.all.begin(), points.all.end(), touches)) +
         static_cast<int>(points.meshes.pairs.size());
}

double solid_work(const Ribbon& ribbon, const ContactProblem& from, const ContactPoints& before,
                  const ContactProblem& to, const ContactPoints& after, double late) {
  double work = 0;
  for (std::size_t i = 0; i < to.solids.size(); ++i) {
    const Pose &pose0 = from.solids[i].pose, &pose1 = to.solids[i].pose;
    if (pose0.position == pose1.position && pose0.frame.coeffs() == pose1.frame.coeffs()) continue;
    visit_points(ribbon, to, i, [&](std::size_t, const Station& at, std::size_t index) {
      const auto add = [&](const ContactPoint& point, const Pose& pose, double share) {
        if (point.gap >= to.distance) return;
        const Vec3 way = pose1.position + pose1.frame * point.at - pose0.position - pose0.frame * point.at;
        const double force = -to.stiffness * at.area * barrier(point.gap, to.distance).first;
        work += share * force * way.dot(pose.frame * point.normal);
      };
      add(before.all[index], pose0, 1 - late);
      add(after.all[index], pose1, late);
    });
  }
  return work + mesh_work(ribbon, from.meshes, before.meshes, to.meshes, after.meshes, late);
}

void add_contact(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const Kinematics& k,
                 const ContactPoints& points, math::ChainSystem& system) {
  const auto touches = [&](std::size_t index) { return points.all[index].gap < problem.distance; };
  for (std::size_t i = 0; i < problem.solids.size(); ++i) {
    const Mat3 to_space = problem.solids[i].pose.frame.toRotationMatrix();
    visit_points(ribbon, problem, i, [&](std::size_t s, const Station& at, std::size_t index) {
      if (!touches(index)) return;
      const auto node = static_cast<int>(s);
      Barrier b = barrier(points.all[index].gap, problem.distance);
      const double weight = problem.stiffness * at.area;
      b = {weight * b.value, weight * b.first, weight * b.second};
      Lever lever{arm(ribbon, chain, k, s, at), {Vec3::Zero(), Vec3::Zero()}};
      if (geometry::eta_is_free(ribbon, node)) lever.slant[0] = (1 - at.share) * at.v * k.frame[s].col(2);
      if (geometry::eta_is_free(ribbon, node + 1)) lever.slant[1] = at.share * at.v * k.frame[s].col(2);
      add_point(lever, to_space * points.all[index].normal, to_space * points.all[index].hessian * to_space.transpose(),
                b, term_of(s, system));
    });
  }
  add_mesh_contact(ribbon, problem.meshes, chain, k, points.meshes, system);
  for (const Friction& friction : problem.friction) {
    add_friction(friction, problem.slip, slide_of(friction, k), term_of(friction.segment, system));
  }
}

void set_friction(const Ribbon& ribbon, const ContactProblem& from, const ContactPoints& points, const Chain& chain,
                  const Kinematics& k, double h, ContactProblem& problem) {
  problem.friction.clear();
  problem.slip = kSlipSpeed * h;
  for (std::size_t i = 0; i < from.solids.size(); ++i) {
    if (problem.solids[i].friction == 0) continue;
    const Pose &pose0 = from.solids[i].pose, &pose1 = problem.solids[i].pose;
    visit_points(ribbon, from, i, [&](std::size_t s, const Station& at, std::size_t index) {
      const ContactPoint& point = points.all[index];
      const double normal_force = -from.stiffness * at.area * barrier(point.gap, from.distance).first;
      if (!(normal_force > 0)) return;
      const double eta = (1 - at.share) * chain.eta[s] + at.share * chain.eta[s + 1];
      Friction friction;
      friction.segment = s;
      friction.along = (at.share - 1) * ribbon.rest_length[s] + at.v * eta;
      friction.across = at.v;
      // Exactly where the point is, moved along as the solid's points are.
      friction.from = k.r[s + 1] + arm(ribbon, chain, k, s, at) + pose1.position + pose1.frame * point.at -
                      pose0.position - pose0.frame * point.at;
      friction.normal = pose1.frame * point.normal;
      friction.force = problem.solids[i].friction * normal_force;
      problem.friction.push_back(friction);
    });
  }
  add_mesh_friction(ribbon, from.meshes, points.meshes, chain, k, problem.meshes, problem.friction);
}

double friction_value(const ContactProblem& problem, const Kinematics& k) {
  double sum = 0;
  for (const Friction& friction : problem.friction) {
    const double way = slide_of(friction, k).way.norm(), share = way / problem.slip;
    sum += friction.force * (share < 1 ? way * share * (1 - share / 3) : way - problem.slip / 3);
  }
  return sum;
}

}  // namespace wunderlich::solver
