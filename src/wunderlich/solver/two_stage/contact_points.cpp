#include "wunderlich/solver/two_stage/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

using contact::Distance;
using geometry::Ribbon;

namespace {

constexpr double kFast = 0.25;       // way in a step over the size of a solid, beyond which points are followed
constexpr int kMostTraces = 200;     // of a point on its way
constexpr int kMostCells = 12;       // along and across a facet
constexpr double kSamePlace = 1e-3;  // share of a facet within which points are one
constexpr int kGoldenSteps = 16;     // in looking for the deepest point
constexpr double kSameDepth = 0.7;   // of the deepest point of a ruling that outer ones must have to count
constexpr double kStraight = 1.05;   // deeper than the chord of the outermost by less: says nothing new

/// Radius of the largest ball inside.
double inner_radius(const contact::Shape& shape) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) {
    return std::min(cylinder->radius, cylinder->half_length);
  }
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) return capsule->radius;
  if (const auto* box = std::get_if<contact::Box>(&shape)) return box->half_size.minCoeff();
  return std::numeric_limits<double>::infinity();
}

/// The grid of points on a facet.
struct Grid {
  std::size_t along, across;  ///< cells
  double width;               ///< of the strip [m]
  double share(std::size_t i) const { return static_cast<double>(i) / static_cast<double>(along); }
  double v(std::size_t k) const { return width * (static_cast<double>(k) / static_cast<double>(across) - 0.5); }
};

/// A facet against one solid, both in the solid's own frame.
struct Facet {
  std::size_t solid, segment;
  Vec3 r0, r1, d2, d3;
  double eta0, eta1;
  bool fast;
  Vec3 at(double share, double v) const {
    return (1 - share) * r0 + share * r1 + v * (d2 + ((1 - share) * eta0 + share * eta1) * d3);
  }
};

Facet facet_of(const geometry::State& shape, const Pose& pose, std::size_t solid, std::size_t s) {
  const Quat own = pose.frame.conjugate() * shape.q[s];
  return {solid,
          s,
          into(pose, shape.r[s]),
          into(pose, shape.r[s + 1]),
          own * Vec3::UnitY(),
          own * Vec3::UnitZ(),
          shape.eta[s],
          shape.eta[s + 1],
          false};
}

/// Radius about the middle that holds the facet.
double reach(const Facet& facet, double width) {
  const double eta = std::max(std::abs(facet.eta0), std::abs(facet.eta1));
  return 0.5 * ((facet.r1 - facet.r0).norm() + width * std::sqrt(1 + eta * eta));
}

/// Longest way of a corner in the step, in the solid's own frame.
double way_of(const Facet& before, const Facet& after, double width) {
  double longest = 0;
  for (const double share : {0.0, 1.0}) {
    for (const double v : {-0.5 * width, 0.5 * width}) {
      longest = std::max(longest, (after.at(share, v) - before.at(share, v)).norm());
    }
  }
  return longest;
}

/// Distance of a point that came from `before`, less what is kept. If it meets the solid on its way, that to the plane
/// tangent where it meets: distance to a convex solid lies above its tangents, so that what is beyond that plane is
/// out.
Distance swept_distance(const contact::Shape& shape, const Vec3& before, const Vec3& after, double kept) {
  const Vec3 way = after - before;
  const double length = way.norm(), close = 1e-3 * inner_radius(shape);
  double gone = 0;
  for (int trace = 0; trace < kMostTraces && gone < length; ++trace) {
    const Vec3 at = before + (gone / length) * way;
    Distance here = contact::distance(shape, at);
    here.value -= kept;
    if (here.value < close) {
      if (here.normal.dot(way) >= 0) break;  // on its way out
      here.value += here.normal.dot(after - at);
      return here;
    }
    gone += here.value;
  }
  Distance end = contact::distance(shape, after);
  end.value -= kept;
  return end;
}

double kept_by(const Workspace& work) { return work.solids.thickness + work.point_margin; }

double start_gap(const Touch& touch, const Workspace& work) {
  const ContactProblem::Solid& solid = work.solids_before.solids[touch.solid];
  return contact::distance(solid.shape, into(solid.pose, place_of(work.before, touch.arm[0].place))).value -
         kept_by(work);
}

/// Adds a point to the touches, unless one is there.
void add_touch(const Facet& facet, double share, double v, double width, Workspace& work) {
  // The ruling at a facet's start is that at the end of the one before.
  const bool shared = share == 0 && facet.segment > 0;
  const Place here = shared ? Place{facet.segment - 1, 1, v} : Place{facet.segment, share, v};
  for (Touch& touch : work.touches) {
    const Place& place = touch.arm[0].place;
    if (!touch.pair && touch.solid == facet.solid && place.segment == here.segment &&
        std::abs(place.share - here.share) < kSamePlace && std::abs(place.v - v) < kSamePlace * width) {
      touch.fast = touch.fast || facet.fast;
      return;
    }
  }
  Touch touch;
  touch.arm[0] = {here, 1, eta_at(work.before, here)};
  touch.solid = facet.solid;
  touch.fast = facet.fast;
  touch.friction = work.solids.solids[facet.solid].friction;
  const Vec3 start = place_of(work.before, here);
  touch.from = out_of(work.solids.solids[facet.solid].pose, into(work.solids_before.solids[facet.solid].pose, start));
  // The gap of a moment ago, with the solid's own motion: where the strip stood is no reason to throw it.
  touch.allowed = allowed_gap(start_gap(touch, work), width);
  work.touches.push_back(touch);
}

/// Of points in a line, by their gaps, those that say all there is to say: the deepest, and the outermost that are
/// inside if they are about as deep. Calls add(index).
template <class Add>
void choose(const std::vector<double>& gaps, double tolerance, const Add& add) {
  std::size_t first = gaps.size(), last = 0, deepest = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    if (gaps[k] >= -tolerance) continue;
    if (first == gaps.size()) first = deepest = k;
    last = k;
    if (gaps[k] < gaps[deepest]) deepest = k;
  }
  if (first == gaps.size()) return;
  const double share = last > first ? static_cast<double>(deepest - first) / static_cast<double>(last - first) : 0;
  const double chord = (1 - share) * gaps[first] + share * gaps[last];
  const bool straight = deepest != first && deepest != last && gaps[deepest] > kStraight * chord;
  if (!straight) add(deepest);
  for (const std::size_t k : {first, last}) {
    if (k != deepest && (straight || gaps[k] < kSameDepth * gaps[deepest])) add(k);
    if (first == last) break;
  }
}

/// Does the solid have edges near, which points of a grid miss? Of a cylinder that the facet meets by its axis too, all
/// that is beyond the axis' end.
bool has_edges(const contact::Shape& shape, const Core& core, const Facet& facet, double width) {
  if (std::holds_alternative<contact::Box>(shape)) return true;
  const auto* cylinder = std::get_if<contact::Cylinder>(&shape);
  if (cylinder == nullptr) return false;
  const double end = core.coarse[facet.segment] != 0 ? core.ends[0].z() : cylinder->half_length;
  return std::abs(facet.at(0.5, 0).z()) + reach(facet, width) > end && std::isfinite(cylinder->half_length);
}

/// The least value of a function without other minima on [0, 1], and where.
template <class Function>
std::pair<double, double> least_between(const Function& value) {
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 1, a = 1 - kGolden, b = kGolden, at_a = value(a), at_b = value(b);
  for (int i = 0; i < kGoldenSteps; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a, a = high - kGolden * (high - low), at_a = value(a);
    } else {
      low = a, a = b, at_a = at_b, b = low + kGolden * (high - low), at_b = value(b);
    }
  }
  return at_a < at_b ? std::pair(at_a, a) : std::pair(at_b, b);
}

/// Is a place beside the part of a cylinder that the facet meets by pairs?
bool in_core(const Core& core, const Facet& facet, const Vec3& at) {
  return core.coarse[facet.segment] != 0 && std::abs(at.z()) < core.ends[0].z();
}

/// The deepest point of a facet that an edge may cut between the grid's points. Distance to a convex solid is convex on
/// a flat facet, and rulings cover it in order: along each, and from one to the next, there is one minimum.
void find_deepest(const Facet& facet, double width, double tolerance, Nearest& nearest, Workspace& work) {
  const contact::Shape& shape = work.solids.solids[facet.solid].shape;
  const auto across = [&](double share) {
    return least_between([&](double g) { return contact::distance(shape, facet.at(share, width * (g - 0.5))).value; });
  };
  const double share = least_between([&](double f) { return across(f).first; }).second;
  const auto [distance, g] = across(share);
  const double gap = distance - kept_by(work);
  const Vec3 at = facet.at(share, width * (g - 0.5));
  nearest.gap = std::min(nearest.gap, gap);
  if (gap < -tolerance && !in_core(work.corners.cores[facet.solid], facet, at)) {
    add_touch(facet, share, width * (g - 0.5), width, work);
  }
}

/// A bound from below on the distance of a ruling: distance to a convex solid lies above its tangent plane.
double ruling_clearance(const contact::Shape& shape, const Facet& facet, double share, double width) {
  const Vec3 middle = facet.at(share, 0);
  const Distance here = contact::distance(shape, middle);
  return here.value - std::abs(here.normal.dot(facet.at(share, 0.5 * width) - middle));
}

void look_at(const Grid& grid, const Facet& facet, const Facet& before, double tolerance, Nearest& nearest,
             Workspace& work) {
  const ContactProblem& solids = work.solids;
  const contact::Shape& shape = solids.solids[facet.solid].shape;
  const double kept = kept_by(work);
  const std::size_t each = grid.across + 1;
  work.gaps.resize((grid.along + 1) * each);
  work.ruling_gaps.resize(grid.along + 1);
  for (std::size_t i = 0; i <= grid.along; ++i) {
    const double clear = facet.fast ? 0 : ruling_clearance(shape, facet, grid.share(i), grid.width) - kept;
    work.ruling_gaps[i] = clear > 0 ? clear : std::numeric_limits<double>::infinity();
    if (clear > 0) continue;
    for (std::size_t k = 0; k < each; ++k) {
      const Vec3 at = facet.at(grid.share(i), grid.v(k));
      const double gap = facet.fast ? swept_distance(shape, before.at(grid.share(i), grid.v(k)), at, kept).value
                                    : contact::distance(shape, at).value - kept;
      work.gaps[i * each + k] = gap;
      work.ruling_gaps[i] = std::min(work.ruling_gaps[i], gap);
    }
  }
  // Facets are flat: what holds for the points of a ruling holds for the rulings of a facet.
  choose(work.ruling_gaps, tolerance, [&](std::size_t i) {
    work.line_gaps.assign(work.gaps.begin() + static_cast<std::ptrdiff_t>(i * each),
                          work.gaps.begin() + static_cast<std::ptrdiff_t>((i + 1) * each));
    choose(work.line_gaps, tolerance,
           [&](std::size_t k) { add_touch(facet, grid.share(i), grid.v(k), grid.width, work); });
  });
  const double least = *std::min_element(work.ruling_gaps.begin(), work.ruling_gaps.end());
  nearest.gap = std::min(nearest.gap, least);
  const double cell =
      grid.width / static_cast<double>(grid.across) + (facet.r1 - facet.r0).norm() / static_cast<double>(grid.along);
  if (least < cell && has_edges(shape, work.corners.cores[facet.solid], facet, grid.width))
    find_deepest(facet, grid.width, tolerance, nearest, work);
}

/// Cells of the grid such that what bends the most bulges between points by half of what is kept. Finer than the
/// barrier's, where every point costs: here few become rows, and fewer do if they are close enough to tell the deepest.
/// Facets for which it is too coarse have pairs instead. Returns what points keep [m].
double refine(const Ribbon& ribbon, ContactProblem& problem) {
  double radius = std::numeric_limits<double>::infinity();
  for (const ContactProblem::Solid& solid : problem.solids) {
    const auto* cylinder = std::get_if<contact::Cylinder>(&solid.shape);
    radius = std::min(radius, cylinder != nullptr ? cylinder->radius : inner_radius(solid.shape));
  }
  const double cell = std::sqrt(2 * radius * kKeeps * problem.distance);
  const auto cells = [&](double size) {
    return static_cast<int>(std::clamp(std::ceil(size / cell), 1.0, static_cast<double>(kMostCells)));
  };
  problem.along = cells(*std::max_element(ribbon.rest_length.begin(), ribbon.rest_length.end()));
  problem.across = cells(ribbon.width);
  return std::isinf(radius) ? 0 : kKeeps * problem.distance;
}

}  // namespace

void set_solids(const Ribbon& ribbon, const constraint::Surroundings& surroundings, double t0, double t1,
                Workspace& work) {
  const auto place = [&](double t, ContactProblem& problem) {
    place_solids(ribbon, surroundings, t, problem);
    work.point_margin = refine(ribbon, problem);
    problem.solids.clear();  // boxes too, which are triangles there
    for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
      problem.solids.push_back({obstacle.shape, constraint::pose_at(obstacle.motion, t), obstacle.friction});
    }
  };
  place(t0, work.solids_before);
  place(t1, work.solids);
}

void find_points(const Ribbon& ribbon, const geometry::State& shape, double tolerance, Nearest& nearest,
                 Workspace& work) {
  const ContactProblem& solids = work.solids;
  const Grid grid{static_cast<std::size_t>(solids.along), static_cast<std::size_t>(solids.across), ribbon.width};
  for (std::size_t i = 0; i < solids.solids.size(); ++i) {
    const contact::Shape& solid = solids.solids[i].shape;
    if (std::holds_alternative<contact::Polyhedron>(solid)) continue;  // met by pairs
    const double size = inner_radius(solid);
    for (std::size_t s = 0; s < shape.q.size(); ++s) {
      const bool coarse = work.corners.cores[i].coarse[s] != 0;
      if (coarse && !std::holds_alternative<contact::Cylinder>(solid)) continue;  // met by pairs, too
      Facet facet = facet_of(shape, solids.solids[i].pose, i, s);
      const Facet before = facet_of(work.before, work.solids_before.solids[i].pose, i, s);
      const double way = way_of(before, facet, ribbon.width);
      facet.fast = way > kFast * size;
      const double clear = contact::distance(solid, facet.at(0.5, 0)).value - reach(facet, ribbon.width);
      if (clear - kept_by(work) > (facet.fast ? way : 0)) {
        nearest.gap = std::min(nearest.gap, clear - kept_by(work));  // a bound from below
        continue;
      }
      if (coarse && !has_edges(solid, work.corners.cores[i], facet, ribbon.width)) continue;
      look_at(grid, facet, before, tolerance, nearest, work);
    }
  }
  nearest.distance = nearest.gap + work.point_margin;
}

void refresh_point(const geometry::State& shape, const Workspace& work, Touch& touch) {
  const ContactProblem::Solid& solid = work.solids.solids[touch.solid];
  const double kept = kept_by(work);
  const Vec3 at = into(solid.pose, place_of(shape, touch.arm[0].place));
  Distance d;
  if (touch.fast) {
    const Vec3 before = into(work.solids_before.solids[touch.solid].pose, place_of(work.before, touch.arm[0].place));
    d = swept_distance(solid.shape, before, at, kept);
  } else {
    d = contact::distance(solid.shape, at);
    d.value -= kept;
  }
  touch.normal = solid.pose.frame * d.normal;
  touch.gap = d.value;
}

}  // namespace wunderlich::solver::two_stage
