#include "wunderlich/solver/two_stage/contact_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/contact/travel.hpp"
#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

using contact::PairKind;
using contact::PairPoints;
using geometry::Ribbon;

namespace {

constexpr double kPasses = 0.05;   // of the distance at the start, or of what is kept: parts that come nearer may pass
constexpr double kFacing = 0.5;    // of the same: where the sides of parts that pass are told
constexpr double kNowhere = 1e-9;  // of the width: parts that are not apart at the start

/// The points of a pair at both ends of the step, in the solid's frame, which is at rest there.
struct Way {
  PairPoints before, now;
};

const contact::TriangleMesh& mesh_of(const Workspace& work, std::size_t solid) {
  return *std::get<contact::Polyhedron>(work.solids.solids[solid].shape).mesh;
}

const Vec3& vertex_of(const Workspace& work, std::size_t solid, int i) {
  const Core& core = work.corners.cores[solid];
  return core.count > 0 ? core.ends[static_cast<std::size_t>(i)]
                        : mesh_of(work, solid).vertices[static_cast<std::size_t>(i)];
}

Way way_of(const Pair& pair, std::size_t solid, const Workspace& work) {
  const Corners& corners = work.corners;
  Way way;
  for (std::size_t k = 0; k < 4; ++k) {
    if (pair.corner[k] < 0) {
      way.before[k] = way.now[k] = vertex_of(work, solid, pair.vertex[k]);
      continue;
    }
    const auto c = static_cast<std::size_t>(pair.corner[k]);
    way.before[k] = corners.before[c], way.now[k] = corners.now[c];
    if (solid == kItself) continue;
    way.before[k] = into(work.solids_before.solids[solid].pose, way.before[k]);
    way.now[k] = into(work.solids.solids[solid].pose, way.now[k]);
  }
  return way;
}

/// How a pair meets at the end of a step.
struct Meeting {
  Vec4 weights;  ///< of its points
  Vec3 normal;   ///< from the second part to the first, in the frame of its points
  double gap;    ///< along it, beyond what is kept [m]
  bool passes;   ///< on straight ways, the parts go through each other or all but do
};

/// Parts that do not pass are as far apart as they are. Those that do are kept apart along the normal that they have
/// where half of their distance is gone, by the points that are nearest there.
Meeting meeting_of(PairKind kind, const Way& way, double start, double kept) {
  const double most = std::min(start, kept);
  PairPoints at = way.now;
  const bool passes = contact::free_share(kind, way.before, way.now, 0, kPasses * most / start) < 1;
  if (passes) {
    const double share = contact::free_share(kind, way.before, way.now, 0, kFacing * most / start);
    for (std::size_t k = 0; k < 4; ++k) at[k] = way.before[k] + share * (way.now[k] - way.before[k]);
  }
  const contact::PairNearest nearest = contact::pair_nearest(kind, at);
  Meeting out{nearest.weights, nearest.way / nearest.distance, 0, passes};
  Vec3 apart = Vec3::Zero();
  for (int k = 0; k < 4; ++k) apart += out.weights[k] * way.now[static_cast<std::size_t>(k)];
  out.gap = out.normal.dot(apart) - kept;
  return out;
}

double kept_by(const Workspace& work, std::size_t solid) {
  const double radius = solid == kItself ? 0 : work.corners.cores[solid].radius;
  return radius + work.solids.thickness + work.corners.margin;
}

/// Arms, normal and gap from a meeting. Of a solid the normal is outward, and only the strip's points are arms.
void take_over(const Meeting& meeting, const Workspace& work, Touch& touch) {
  const Pair& pair = *touch.pair;
  const Corners& corners = work.corners;
  const bool itself = touch.solid == kItself;
  const double side = !itself && pair.corner[0] < 0 ? -1 : 1;  // the strip's part is the second
  touch.normal = side * meeting.normal;
  if (!itself) touch.normal = work.solids.solids[touch.solid].pose.frame * touch.normal;
  touch.gap = meeting.gap;
  touch.arm_count = 0;
  touch.from.setZero();
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = side * meeting.weights[static_cast<Eigen::Index>(k)];
    if (pair.corner[k] < 0 || weight == 0) continue;
    const auto c = static_cast<std::size_t>(pair.corner[k]);
    touch.arm[touch.arm_count++] = {corners.place[c], weight, corners.eta_before[c]};
    Vec3 start = corners.before[c];
    if (!itself) {
      start = out_of(work.solids.solids[touch.solid].pose, into(work.solids_before.solids[touch.solid].pose, start));
    }
    touch.from += weight * start;
  }
}

bool same_arms(const Touch& a, const Touch& b) {
  if (a.arm_count != b.arm_count) return false;
  const auto has = [&](const Arm& arm) {
    return std::any_of(b.arms().begin(), b.arms().end(), [&](const Arm& other) {
      return arm.place.segment == other.place.segment && arm.place.share == other.place.share &&
             arm.place.v == other.place.v && arm.weight == other.weight;
    });
  };
  return std::all_of(a.arms().begin(), a.arms().end(), has);
}

bool is_there(const Touch& touch, const std::vector<Touch>& touches) {
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& other) {
    if (!other.pair || other.solid != touch.solid) return false;
    const Pair &a = *touch.pair, &b = *other.pair;
    if (a.kind == b.kind && a.corner == b.corner && a.vertex == b.vertex) return true;
    // Parts meet at a corner that they share with others: others say the same.
    return same_arms(touch, other) && touch.normal.dot(other.normal) > 1 - 1e-12;
  });
}

void look_at(const Pair& pair, std::size_t solid, double tolerance, Nearest& nearest, Workspace& work) {
  const Way way = way_of(pair, solid, work);
  const double kept = kept_by(work, solid), start = contact::pair_distance(pair.kind, way.before);
  double longest = 0;
  for (std::size_t k = 0; k < 4; ++k) longest = std::max(longest, (way.now[k] - way.before[k]).squaredNorm());
  if (start - 2 * std::sqrt(longest) > kept) return;
  if (!(start > kNowhere * work.corners.width)) {
    nearest.passes = true;
    return;
  }
  const Meeting meeting = meeting_of(pair.kind, way, start, kept);
  nearest.passes = nearest.passes || meeting.passes;
  nearest.distance = std::min(nearest.distance, meeting.gap + work.corners.margin);
  nearest.gap = std::min(nearest.gap, meeting.gap + work.corners.margin);
  if (meeting.gap >= -tolerance) return;
  Touch touch;
  touch.solid = solid;
  touch.pair = pair;
  touch.friction = solid == kItself ? work.corners.self.friction : work.solids.solids[solid].friction;
  touch.allowed = allowed_gap(start - kept, work.corners.width);
  take_over(meeting, work, touch);
  if (!is_there(touch, work.touches)) work.touches.push_back(touch);
}

void find_own_pairs(double tolerance, Nearest& nearest, Workspace& work) {
  Corners& corners = work.corners;
  find_candidates(corners.self, corners.before, corners.now, corners.self_search);
  nearest.gap = std::min(nearest.gap, corners.margin);  // where nothing is nearer
  nearest.distance = std::min(nearest.distance, corners.margin);
  for (const SelfPair& pair : corners.self_search.candidates) {
    look_at({pair.kind, pair.corner, {-1, -1, -1, -1}}, kItself, tolerance, nearest, work);
  }
}

/// Corners of all facets at both ends of the step, in a solid's own frame.
void place_facets(std::size_t solid, Workspace& work) {
  Corners& corners = work.corners;
  const std::size_t segments = corners.now.size() / 2 - 1;
  corners.facets_before.resize(segments), corners.facets.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    for (std::size_t k = 0; k < 4; ++k) {
      corners.facets_before[s][k] = into(work.solids_before.solids[solid].pose, corners.before[2 * s + k]);
      corners.facets[s][k] = into(work.solids.solids[solid].pose, corners.now[2 * s + k]);
    }
  }
}

/// Whatever is nearest to an axis is an edge that it crosses, or a face above its end. Edges along the strip follow the
/// frames to the parallel error only, so that four corners may span a tetrahedron, however thin. All of that is met: no
/// straight piece gets into it but across an edge or by an end.
void find_pairs_with_core(std::size_t solid, double tolerance, Nearest& nearest, Workspace& work) {
  static constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0, 3}, {1, 2}}};
  static constexpr std::array<std::array<int, 3>, 4> kTriangles{{{0, 1, 2}, {1, 3, 2}, {0, 1, 3}, {0, 3, 2}}};
  const Corners& corners = work.corners;
  const Core& core = corners.cores[solid];
  const double kept = kept_by(work, solid);
  contact::Extent around{core.ends[0], core.ends[0]};
  around.add(core.ends[static_cast<std::size_t>(core.count - 1)]);
  place_facets(solid, work);
  for (std::size_t s = 0; s < core.coarse.size(); ++s) {
    if (core.coarse[s] == 0) continue;
    contact::Extent box = box_of(corners.facets_before[s]);
    box.add(box_of(corners.facets[s]));
    const double away = contact::apart(box, around);
    if (away > kept) {
      nearest.gap = std::min(nearest.gap, away - kept + corners.margin);  // a bound from below
      nearest.distance = std::min(nearest.distance, away - kept + corners.margin);
      continue;
    }
    const int first = 2 * static_cast<int>(s);
    for (const auto& edge : kEdges) {
      if (core.count < 2) break;
      look_at({PairKind::edge_edge, {first + edge[0], first + edge[1], -1, -1}, {-1, -1, 0, 1}}, solid, tolerance,
              nearest, work);
    }
    for (const auto& t : kTriangles) {
      for (int end = 0; end < core.count; ++end) {
        look_at({PairKind::vertex_triangle, {-1, first + t[0], first + t[1], first + t[2]}, {end, -1, -1, -1}}, solid,
                tolerance, nearest, work);
      }
    }
  }
}

void find_pairs_with(std::size_t solid, double tolerance, Nearest& nearest, Workspace& work) {
  const contact::TriangleMesh& mesh = mesh_of(work, solid);
  const Corners& corners = work.corners;
  const double kept = kept_by(work, solid);
  place_facets(solid, work);
  const std::vector<PairPoints>&before = corners.facets_before, &now = corners.facets;
  const auto widened = [&](contact::Extent box, const contact::Extent& end) {
    box.add(end);
    box.widen(kept);
    return box;
  };
  gather(now.size(), work.corners.mesh_search, [&](std::size_t s) {
    const double away = contact::apart(widened(box_of(before[s]), box_of(now[s])), mesh.whole);
    nearest.gap = std::min(nearest.gap, away + corners.margin);  // a bound from below
    nearest.distance = std::min(nearest.distance, away + corners.margin);
    return !(away > 0);
  });
  const auto box = [&](const FacetPart& part) {
    return widened(box_of(part, before[part.segment]), box_of(part, now[part.segment]));
  };
  match_all(solid, mesh, work.corners.mesh_search, box, [&](const FacetPair& near) {
    Pair pair{near.kind, near.corner, near.vertex};
    for (int& corner : pair.corner) {
      if (corner >= 0) corner += 2 * static_cast<int>(near.segment);
    }
    look_at(pair, solid, tolerance, nearest, work);
  });
}

/// The straight piece or point that a round solid is around. Where it has no end it is cut off beyond all of the
/// strip's reach.
void set_core(const contact::Shape& shape, double reach, Core& core) {
  const auto piece = [&](double radius, double half_length) {
    core.radius = radius;
    core.count = half_length > 0 ? 2 : 1;
    const Vec3 end(0, 0, std::min(std::max(half_length, 0.0), reach));
    core.ends = {end, -end};
  };
  piece(0, 0);
  core.count = 0;
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) piece(sphere->radius, 0);
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) piece(capsule->radius, capsule->half_length);
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) {
    piece(std::min(cylinder->radius, cylinder->half_length), cylinder->half_length - cylinder->radius);
  }
}

/// The square of the distance to a center or an axis, less that of a point's place, is concave: on a chord of length c
/// whose ends are at R nothing is nearer by more than c^2/8R. In a cell of the grid a point lies on a chord along a
/// ruling whose ends lie on chords along the strip, so that both add up. Rulings may turn in the step: twice as much
/// must fit into what is kept.
bool is_coarse(const Ribbon& ribbon, const Workspace& work, std::size_t s, double radius) {
  const std::vector<double>& eta = work.before.eta;
  const double side = (ribbon.rest_length[s] + 0.5 * ribbon.width * std::abs(eta[s + 1] - eta[s])) / work.solids.along;
  const double lean = std::max(std::abs(eta[s]), std::abs(eta[s + 1])), cell = ribbon.width / work.solids.across;
  return 2 * (side * side + cell * cell * (1 + lean * lean)) > 8 * (radius + work.solids.thickness) * work.point_margin;
}

void set_cores(const Ribbon& ribbon, Workspace& work) {
  Corners& corners = work.corners;
  corners.cores.resize(work.solids.solids.size());
  corners.has_meshes = corners.has_cores = false;
  for (std::size_t i = 0; i < corners.cores.size(); ++i) {
    Core& core = corners.cores[i];
    const auto& solid = work.solids.solids[i];
    corners.has_meshes = corners.has_meshes || std::holds_alternative<contact::Polyhedron>(solid.shape);
    const double length = static_cast<double>(ribbon.rest_length.size()) *
                          *std::max_element(ribbon.rest_length.begin(), ribbon.rest_length.end());
    set_core(solid.shape, into(work.solids_before.solids[i].pose, work.before.r[0]).norm() + 4 * length, core);
    core.coarse.assign(ribbon.rest_length.size(), 0);
    for (std::size_t s = 0; s < core.coarse.size() && core.count > 0; ++s) {
      core.coarse[s] = is_coarse(ribbon, work, s, core.radius);
      corners.has_cores = corners.has_cores || core.coarse[s] != 0;
    }
  }
}

bool meets_pairs(const Corners& corners) { return corners.has_meshes || corners.has_cores || corners.self.active(); }

void place_corners(const geometry::State& shape, const std::vector<Place>& places, std::vector<Vec3>& out) {
  out.clear();
  for (const Place& place : places) out.push_back(place_of(shape, place));
}

}  // namespace

void set_pairs(const Ribbon& ribbon, const constraint::Surroundings& surroundings, Workspace& work) {
  Corners& corners = work.corners;
  corners.margin = kKeeps * surroundings.contact.distance;
  corners.width = ribbon.width;
  corners.self.reach = 0;
  place_self(ribbon, surroundings, corners.margin, true, work.before.eta, corners.self);
  set_cores(ribbon, work);
  if (!meets_pairs(corners)) return;
  corners.place.clear();
  corners.eta_before.clear();
  for (std::size_t i = 0; i < work.before.r.size(); ++i) {
    for (const double v : {-0.5 * ribbon.width, 0.5 * ribbon.width}) {
      // The ruling at a facet's start is that at the end of the one before.
      corners.place.push_back(i == 0 ? Place{0, 0, v} : Place{i - 1, 1, v});
      corners.eta_before.push_back(work.before.eta[i]);
    }
  }
  place_corners(work.before, corners.place, corners.before);
}

void find_pairs(const geometry::State& shape, double tolerance, Nearest& nearest, Workspace& work) {
  Corners& corners = work.corners;
  if (!meets_pairs(corners)) return;
  place_corners(shape, corners.place, corners.now);
  if (corners.self.active()) find_own_pairs(tolerance, nearest, work);
  for (std::size_t i = 0; i < work.solids.solids.size(); ++i) {
    const Core& core = corners.cores[i];
    if (std::holds_alternative<contact::Polyhedron>(work.solids.solids[i].shape)) {
      find_pairs_with(i, tolerance, nearest, work);
    } else if (std::find(core.coarse.begin(), core.coarse.end(), 1) != core.coarse.end()) {
      find_pairs_with_core(i, tolerance, nearest, work);
    }
  }
}

void refresh_pair(const Workspace& work, Touch& touch) {
  const Way way = way_of(*touch.pair, touch.solid, work);
  const double start = contact::pair_distance(touch.pair->kind, way.before);
  take_over(meeting_of(touch.pair->kind, way, start, kept_by(work, touch.solid)), work, touch);
}

}  // namespace wunderlich::solver::two_stage
