#include "wunderlich/baseline/rod/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/contact/barrier.hpp"

namespace wunderlich::baseline::rod {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStiffness = 100;  // barrier over weight or bending, as for the ribbon
constexpr int kMostCells = 12;      // across the strip, and along an edge

double smallest_radius(const contact::Shape& shape) {
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) return cylinder->radius;
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) return capsule->radius;
  return kInfinity;
}

/// A point of an edge: at a share f of it and v across.
struct Place {
  double f, v;
};

/// Shares of points along an edge: its middle for one cell, evenly spread else. Cells have equal areas.
template <class Take>
void for_places(const Rod& rod, const Solids& solids, Take&& take) {
  for (int a = 0; a < solids.along; ++a) {
    for (int c = 0; c <= solids.across; ++c) {
      const double share = c == 0 || c == solids.across ? 0.5 : 1.0;  // of a cell's area, by the trapezoidal rule
      take(Place{(a + 0.5) / solids.along, rod.width * (static_cast<double>(c) / solids.across - 0.5)}, share);
    }
  }
}

Vec3 point_at(const Rod&, const State& state, std::size_t edge, const Section& s, const Place& p) {
  return (1 - p.f) * state.x[edge] + p.f * state.x[edge + 1] + p.v * s.m2;
}

/// Derivatives of a function of one point by the coordinates of its edge.
void add_point(const Section& s, double length, const Place& p, const Vec3& slope, const Mat3& bend, TouchTerms& out) {
  // m2 turns by theta towards -m1, and when the edge turns it moves along the edge only.
  Eigen::Matrix<double, 3, 7> rows = Eigen::Matrix<double, 3, 7>::Zero();
  const Mat3 by_edge = -p.v / length * s.m3 * s.m2.transpose();
  rows.leftCols<3>() = (1 - p.f) * Mat3::Identity() - by_edge;
  rows.col(3) = -p.v * s.m1;
  rows.rightCols<3>() = p.f * Mat3::Identity() + by_edge;
  out.gradient += rows.transpose() * slope;
  out.hessian += rows.transpose() * bend * rows;
  // Second derivatives of m2 along the slope, by (edge, theta).
  const double along = slope.dot(s.m3);
  const Vec3 square = slope - along * s.m3;
  const Mat3 mixed = s.m2 * (along * s.m3 / length - 0.5 * square / length).transpose();
  const Mat3 ee = p.v / length * (mixed + mixed.transpose());
  const Vec3 et = p.v / length * along * s.m1;
  out.hessian.topLeftCorner<3, 3>() += ee;
  out.hessian.bottomRightCorner<3, 3>() += ee;
  out.hessian.topRightCorner<3, 3>() -= ee;
  out.hessian.bottomLeftCorner<3, 3>() -= ee;
  out.hessian.block<3, 1>(0, 3) -= et;
  out.hessian.block<1, 3>(3, 0) -= et.transpose();
  out.hessian.block<3, 1>(4, 3) += et;
  out.hessian.block<1, 3>(3, 4) += et.transpose();
  out.hessian(3, 3) -= p.v * slope.dot(s.m2);
}

}  // namespace

Solids solids_at(const Rod& rod, const constraint::Surroundings& surroundings, double time) {
  Solids out;
  double radius = kInfinity;
  for (const constraint::Obstacle& obstacle : surroundings.obstacles) {
    out.solids.push_back({obstacle.shape, constraint::pose_at(obstacle.motion, time)});
    radius = std::min(radius, smallest_radius(obstacle.shape));
  }
  if (out.solids.empty()) return out;
  const double w = rod.width, d = surroundings.contact.distance;
  const double bending = rod.stiffness.soft / (w * w * w * w);
  out.distance = d;
  out.stiffness = kStiffness * std::max(rod.area_density * surroundings.gravity.norm(), bending) / d;
  // Points that are c apart and c^2/(8 R) off a solid of radius R leave it room between them.
  const double cell = radius < kInfinity ? std::sqrt(radius * d) : kInfinity;
  const auto cells = [&](double size) {
    return static_cast<int>(std::clamp(std::ceil(size / cell), 1.0, static_cast<double>(kMostCells)));
  };
  const double longest = *std::max_element(rod.rest_length.begin(), rod.rest_length.end());
  out.across = std::max(2, cells(w));
  out.along = cells(longest);
  const double side = std::max(w / out.across, longest / out.along);
  out.kept = surroundings.contact.thickness + std::min(0.5 * side * side / radius, d);
  return out;
}

double barrier_energy(const Rod& rod, const Solids& solids, const State& state, std::size_t edge, TouchTerms* terms) {
  if (solids.solids.empty()) return 0;
  const Section s = section(state, edge);
  const double length = (state.x[edge + 1] - state.x[edge]).norm();
  const double area = rod.rest_length[edge] / solids.along * rod.width / solids.across;
  double energy = 0;
  for_places(rod, solids, [&](const Place& place, double share) {
    const Vec3 point = point_at(rod, state, edge, s, place);
    for (const Solids::Solid& solid : solids.solids) {
      const contact::Distance d = contact::distance(solid.shape, solid.pose, point);
      const double weight = solids.stiffness * area * share;
      const contact::Barrier b = contact::barrier(d.value - solids.kept, solids.distance);
      energy += weight * b.value;
      if (terms == nullptr || b.value == 0) continue;
      add_point(s, length, place, weight * b.first * d.normal,
                weight * (b.second * d.normal * d.normal.transpose() + b.first * d.hessian), *terms);
    }
  });
  return energy;
}

double clearance(const Rod& rod, const constraint::Surroundings& surroundings, const State& state) {
  const Solids solids = solids_at(rod, surroundings, state.time);
  double least = kInfinity;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const Section s = section(state, j);
    for_places(rod, solids, [&](const Place& place, double) {
      const Vec3 point = point_at(rod, state, j, s, place);
      for (const Solids::Solid& solid : solids.solids)
        least = std::min(least, contact::distance(solid.shape, solid.pose, point).value);
    });
  }
  return least - surroundings.contact.thickness;
}

}  // namespace wunderlich::baseline::rod
