#include "wunderlich/solver/chain_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/contact/barrier.hpp"
#include "wunderlich/solver/coulomb.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;

namespace {

constexpr double kStiffness = 100;  // barrier over weight or bending: light contact, few iterations
constexpr int kMostCells = 100;     // across a strip, and along a segment; where that is too coarse points keep more
constexpr double kRoom = 0.5;       // of the distance at which forces begin: what points keep ...
constexpr double kLean = 0.35;      // ... where rulings lean by so much
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double radius_of(const contact::Shape& shape) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) return cylinder->radius;
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) return capsule->radius;
  return kInfinity;
}

/// Rows of points are along rulings. Beside planes a ruling's points belong to the segment before alone; beside what is
/// round both keep what they need.
int first_row(const ContactFacet& facet, std::size_t segment) { return segment == 0 || facet.sag[0] > 0 ? 0 : 1; }

/// Length along the strip that a row stands for, trapezoidal.
double row_length(const Ribbon& ribbon, const ContactProblem& problem, const ContactFacet& facet, std::size_t segment,
                  int row) {
  const bool shared = segment + 1 < ribbon.rest_length.size() && first_row(facet, segment + 1) == 1;
  double length = facet.length;
  if (row == 0) length = 0.5 * facet.length;
  if (row == problem.along) length = 0.5 * (facet.length + (shared ? ribbon.rest_length[segment + 1] : 0));
  return length / problem.along;
}

double share_of(const ContactProblem& problem, int row) { return static_cast<double>(row) / problem.along; }

double across_at(const ContactProblem& problem, int column) {
  return (static_cast<double>(column) / problem.across - 0.5) * problem.width;
}

/// The facet of a segment in a solid's own frame; whether it is near is still to be found.
ContactFacet contact_facet(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const Kinematics& k,
                           std::size_t s, std::size_t solid, const Mat3& to_own) {
  ContactFacet facet;
  const Vec3 d2 = to_own * k.frame[s].col(1), d3 = to_own * k.frame[s].col(2);
  facet.start = to_own * (k.r[s] - problem.solids[solid].pose.position);
  facet.along = ribbon.rest_length[s] * d3;
  facet.across[0] = d2 + chain.eta[s] * d3;
  facet.across[1] = d2 + chain.eta[s + 1] * d3;
  facet.length = ribbon.rest_length[s];
  facet.eta[0] = chain.eta[s], facet.eta[1] = chain.eta[s + 1];
  facet.sag[0] = problem.solids[solid].sag / (problem.along * problem.along);
  const double across = problem.width / problem.across;
  facet.sag[1] = problem.solids[solid].sag * across * across;
  // Convex along the strip and across it: the most is at a corner.
  const double half = 0.5 * problem.width;
  facet.kept = problem.thickness + std::max(std::max(facet.margin(0, -half), facet.margin(0, half)),
                                            std::max(facet.margin(1, -half), facet.margin(1, half)));
  facet.gap = facet.least = 0;
  facet.near = false;
  facet.first = 0;
  return facet;
}

/// The distance to a convex solid lies above its tangent plane, on the facet above the lowest of the corners' values.
double least_gap(const ContactFacet& facet, double half_width) {
  const double along = 0.5 * facet.normal.dot(facet.along);
  const double start = std::abs(facet.normal.dot(facet.across[0])), end = std::abs(facet.normal.dot(facet.across[1]));
  return facet.gap - std::max(along + half_width * start, half_width * end - along);
}

/// Adds the points of a facet that may be near its solid.
void look_at(const Ribbon& ribbon, const ContactProblem& problem, const contact::Shape& shape, std::size_t s,
             std::size_t index, ContactPoints& points) {
  ContactFacet& facet = points.facets[index];
  facet.near = true;
  facet.first = points.at.size();
  const int first = first_row(facet, s);
  const std::size_t count = static_cast<std::size_t>((problem.along + 1 - first) * (problem.across + 1));
  const std::size_t end = facet.first + count;
  points.at.resize(end);
  Vec3* at = points.at.data() + facet.first;
  for (int i = first; i <= problem.along; ++i) {
    const double f = share_of(problem, i);
    const Vec3 node = facet.start + f * facet.along;
    const Vec3 ruling = (1 - f) * facet.across[0] + f * facet.across[1];
    for (int k = 0; k <= problem.across; ++k) *at++ = node + across_at(problem, k) * ruling;
  }
  points.gap.resize(end);
  points.normal.resize(end);
  contact::distances(shape, count, points.at.data() + facet.first, points.gap.data() + facet.first,
                     points.normal.data() + facet.first);
  const double cell = problem.width / problem.across;
  std::size_t point = facet.first;
  facet.least = kInfinity;
  for (int i = first; i <= problem.along; ++i) {
    for (int k = 0; k <= problem.across; ++k, ++point) {
      const double gap = points.gap[point] -=
          problem.thickness + facet.margin(share_of(problem, i), across_at(problem, k));
      facet.least = std::min(facet.least, gap);
      if (gap >= problem.distance) continue;
      const double area = (k == 0 || k == problem.across ? 0.5 : 1) * cell * row_length(ribbon, problem, facet, s, i);
      points.touches.push_back({index, point, share_of(problem, i), across_at(problem, k), area,
                                gap > 0 ? std::log(gap / problem.distance) : -kInfinity});
    }
  }
}

/// Where a point is, with the solid's normal, its gap there and what it keeps.
struct Beside {
  Vec3 at, normal;
  double gap, kept;
};

/// The least that the distance to a convex solid can be on a straight way: it is convex, above its tangents at the
/// ends. What is kept on the way is at most what is between what is kept there: squares of lengths are convex, too.
inline double lowest_on_way(const Beside& a, const Beside& b) {
  const Vec3 way = b.at - a.at;
  const double more = b.kept - a.kept, least = std::min(a.gap, b.gap);
  const double down = a.normal.dot(way) - more, up = b.normal.dot(way) - more;
  if (down >= 0 || up <= 0) return least;
  return std::min(least, a.gap + down * (a.gap - b.gap + up) / (up - down));
}

/// A point of a facet: it need not be one that was looked at.
inline Beside point_of(const ContactProblem& problem, const contact::Shape& shape, const ContactPoints& points,
                       const ContactFacet& facet, std::size_t offset, double f, double v) {
  const std::size_t i = facet.first + offset;
  const double kept = problem.thickness + facet.margin(f, v);
  if (facet.near) return {points.at[i], points.normal[i], points.gap[i], kept};
  Beside beside{facet.at(f, v), {}, 0, kept};
  contact::distances(shape, 1, &beside.at, &beside.gap, &beside.normal);
  beside.gap -= kept;
  return beside;
}

/// How much more than before a point of the facet may keep.
double most_more(const ContactFacet& a, const ContactFacet& b, double half_width) {
  const double longer = std::abs(b.eta[1] - b.eta[0] - a.eta[1] + a.eta[0]) * half_width;
  const double lean = std::max(std::abs(b.eta[0] - a.eta[0]), std::abs(b.eta[1] - a.eta[1]));
  const double leans = std::max(std::abs(b.eta[0] + a.eta[0]), std::abs(b.eta[1] + a.eta[1]));
  const double lengths = 2 * a.length + std::abs(b.eta[1] - b.eta[0] + a.eta[1] - a.eta[0]) * half_width;
  return b.sag[0] * longer * lengths + b.sag[1] * lean * leans;
}

/// Largest way of a facet's points: they lie between its corners, and so do their ways.
double longest_way(const ContactFacet& a, const ContactFacet& b, double half_width) {
  const Vec3 start = b.start - a.start, end = start + b.along - a.along;
  double most = 0;
  for (int c = 0; c < 2; ++c) {
    const Vec3 slant = half_width * (b.across[c] - a.across[c]), &node = c == 0 ? start : end;
    most = std::max({most, (node + slant).squaredNorm(), (node - slant).squaredNorm()});
  }
  return std::sqrt(most);
}

/// No point of the facet is farther from its middle.
double radius(const ContactFacet& facet, double half_width) {
  double most = 0;
  for (const Vec3& across : facet.across) {
    const Vec3 along = 0.5 * facet.along, slant = half_width * across;
    most = std::max({most, (along + slant).squaredNorm(), (along - slant).squaredNorm()});
  }
  return std::sqrt(most);
}

/// The same for the points of one facet.
bool facet_may_go(const ContactProblem& problem, std::size_t index, const ContactPoints& from,
                  const ContactPoints& to) {
  const ContactFacet &a = from.facets[index], &b = to.facets[index];
  const double half_width = 0.5 * problem.width;
  if (longest_way(a, b, half_width) + most_more(a, b, half_width) < (1 - contact::kLeastShare) * a.least) return true;
  // Points stay as near to the middle as they are at both ends: lengths are convex along the way, too.
  const bool far = !(a.near && b.near);
  const double around = far ? std::max(radius(a, half_width), radius(b, half_width)) : 0;
  const Beside here{a.middle(), a.normal, a.gap, a.kept}, there{b.middle(), b.normal, b.gap, b.kept};
  if (far && lowest_on_way(here, there) > around) return true;
  const contact::Shape& shape = problem.solids[index % problem.solids.size()].shape;
  const int first = first_row(a, index / problem.solids.size());
  std::size_t offset = 0;
  for (int i = first; i <= problem.along; ++i) {
    const double f = share_of(problem, i);
    for (int k = 0; k <= problem.across; ++k, ++offset) {
      const double v = across_at(problem, k);
      const Beside p = point_of(problem, shape, from, a, offset, f, v);
      const Beside q = point_of(problem, shape, to, b, offset, f, v);
      if (!(q.gap >= contact::kLeastShare * std::min(p.gap, problem.distance)) || !(lowest_on_way(p, q) > 0))
        return false;
    }
  }
  return true;
}

/// Force of the barrier on a point [N].
double force_on(const ContactProblem& problem, const ContactPoints& points, const Touch& touch) {
  return -problem.stiffness * touch.area *
         contact::barrier_slopes(points.gap[touch.point], problem.distance, touch.log).first;
}

/// The grid with the fewest points whose margin is at most what there is room for; the finest if none is.
///
/// The square of the distance to a center or an axis, less that of a point's place, is concave. So on a chord of length
/// c whose ends have distances R + m + g and more from it, with m = c^2/8R, nothing is nearer than R + g. In a cell of
/// the grid a point lies on a chord along a ruling, whose ends lie on chords along the strip: m adds both squares.
void set_grid(const Ribbon& ribbon, double radius, ContactProblem& problem) {
  const double longest = *std::max_element(ribbon.rest_length.begin(), ribbon.rest_length.end());
  const double room = 8 * radius * kRoom * problem.distance, ruling = problem.width * std::sqrt(1 + kLean * kLean);
  const auto points = [](int along, double across) { return (along + 1) * (across + 1); };
  problem.along = problem.across = radius < kInfinity ? kMostCells : 1;
  for (int along = 1; points(along, 1) < points(problem.along, problem.across); ++along) {
    const double left = room - longest / along * (longest / along);
    if (!(left > 0)) continue;
    const double across = std::ceil(ruling / std::sqrt(left));
    if (points(along, across) >= points(problem.along, problem.across)) continue;
    problem.along = along;
    problem.across = static_cast<int>(across);
  }
}

}  // namespace

void place_solids(const Ribbon& ribbon, const constraint::Surroundings& surroundings, double t,
                  ContactProblem& problem) {
  problem.solids.clear();
  problem.friction.clear();
  double radius = kInfinity;
  for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
    if (is_mesh(obstacle.shape)) continue;
    const double own = radius_of(obstacle.shape) + surroundings.contact.thickness;
    problem.solids.push_back(
        {obstacle.shape, constraint::pose_at(obstacle.motion, t), obstacle.friction, 1 / (8 * own)});
    radius = std::min(radius, own);
  }
  const double w = ribbon.width, d = surroundings.contact.distance;
  problem.width = w;
  problem.distance = d;
  problem.thickness = surroundings.contact.thickness;
  const double load = ribbon.area_density * surroundings.gravity.norm();
  problem.stiffness = kStiffness * std::max(load, ribbon.bending_stiffness / (w * w * w)) / d;
  place_meshes(surroundings, t, problem.stiffness, problem.meshes);
  set_grid(ribbon, radius, problem);
}

void find_points(const Ribbon& ribbon, const ContactProblem& problem, const Chain& chain, const Kinematics& k,
                 ContactPoints& points) {
  const std::size_t n = ribbon.rest_length.size(), count = problem.solids.size();
  points.clear();
  find_mesh_pairs(ribbon, problem.meshes, chain, k, points.meshes);
  points.facets.resize(n * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Mat3 to_own = problem.solids[i].pose.frame.conjugate().toRotationMatrix();
    for (std::size_t s = 0; s < n; ++s)
      points.facets[s * count + i] = contact_facet(ribbon, problem, chain, k, s, i, to_own);
  }
  for (std::size_t index = 0; index < points.facets.size(); ++index) {
    ContactFacet& facet = points.facets[index];
    const contact::Shape& shape = problem.solids[index % count].shape;
    const Vec3 middle = facet.middle();
    contact::distances(shape, 1, &middle, &facet.gap, &facet.normal);
    facet.gap -= facet.kept;
    facet.least = least_gap(facet, 0.5 * problem.width);
    // What is not a number is looked at as well, and is refused there.
    if (!(facet.least > problem.distance)) look_at(ribbon, problem, shape, index / count, index, points);
  }
}

double contact_energy(const Ribbon& ribbon, const ContactProblem& problem, const ContactPoints& points) {
  double sum = 0;
  for (const Touch& touch : points.touches)
    sum += touch.area * contact::barrier_value(points.gap[touch.point], problem.distance, touch.log);
  return problem.stiffness * sum + mesh_energy(ribbon, problem.meshes, points.meshes);
}

bool may_go(const ContactProblem& problem, const ContactPoints& from, ContactPoints& to) {
  for (std::size_t i = 0; i < from.facets.size(); ++i) {
    if (!facet_may_go(problem, i, from, to)) return false;
  }
  return mesh_may_go(problem.meshes, from.meshes, to.meshes, to.meshes.search);
}

double smallest_distance(const ContactProblem& problem, const ContactPoints& points) {
  double least = mesh_distance(problem.meshes, points.meshes);
  for (const ContactFacet& facet : points.facets) least = std::min(least, facet.least);
  return least;
}

int contact_count(const ContactPoints& points) {
  return static_cast<int>(points.touches.size() + points.meshes.pairs.size());
}

double solid_work(const Ribbon& ribbon, const ContactProblem& from, const ContactPoints& before,
                  const ContactProblem& to, const ContactPoints& after, double late) {
  double work = 0;
  const auto add = [&](const ContactPoints& points, const ContactProblem& problem, double share) {
    for (const Touch& touch : points.touches) {
      const std::size_t solid = touch.facet % to.solids.size();
      const Pose &pose0 = from.solids[solid].pose, &pose1 = to.solids[solid].pose;
      if (pose0.position == pose1.position && pose0.frame.coeffs() == pose1.frame.coeffs()) continue;
      const Vec3& at = points.at[touch.point];
      const Vec3 way = pose1.position + pose1.frame * at - pose0.position - pose0.frame * at;
      const Vec3 normal = problem.solids[solid].pose.frame * points.normal[touch.point];
      work += share * force_on(problem, points, touch) * way.dot(normal);
    }
  };
  add(before, from, 1 - late);
  add(after, to, late);
  return work + mesh_work(ribbon, from.meshes, before.meshes, to.meshes, after.meshes, late);
}

void set_friction(const Ribbon& ribbon, const ContactProblem& from, const ContactPoints& points, const Chain& chain,
                  const Kinematics& k, double h, ContactProblem& problem) {
  problem.friction.clear();
  problem.slip = kSlipSpeed * h;
  const std::size_t count = from.solids.size();
  for (auto touch = points.touches.rbegin(); touch != points.touches.rend(); ++touch) {
    const std::size_t i = touch->facet % count, s = touch->facet / count;
    if (problem.solids[i].friction == 0) continue;
    const Pose &pose0 = from.solids[i].pose, &pose1 = problem.solids[i].pose;
    const double eta = (1 - touch->share) * chain.eta[s] + touch->share * chain.eta[s + 1];
    Friction friction;
    friction.segment = s;
    friction.along = (touch->share - 1) * ribbon.rest_length[s] + touch->v * eta;
    friction.across = touch->v;
    // Exactly where the point is, moved along as the solid's points are.
    const Vec3& at = points.at[touch->point];
    friction.carried = pose1.position + pose1.frame * at - pose0.position - pose0.frame * at;
    friction.from =
        k.r[s + 1] + friction.along * k.frame[s].col(2) + friction.across * k.frame[s].col(1) + friction.carried;
    friction.normal = pose1.frame * points.normal[touch->point];
    friction.force = problem.solids[i].friction * force_on(from, points, *touch);
    problem.friction.push_back(friction);
  }
  if (from.meshes.solids.empty()) return;
  add_mesh_friction(ribbon, from.meshes, points.meshes, chain, k, problem.meshes, problem.friction);
  const auto later = [](const Friction& a, const Friction& b) { return a.segment > b.segment; };
  std::stable_sort(problem.friction.begin(), problem.friction.end(), later);
}

}  // namespace wunderlich::solver
