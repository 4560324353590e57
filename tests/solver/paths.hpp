/// Problems on loading paths, and running them to their end.
#pragma once

#include <string>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/geometry/ribbon.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::testing {

constexpr double kPi = 3.14159265358979323846;

/// A path at its end, with everything a test looks at.
struct PathEnd {
  solver::PathProblem path;
  solver::PathState at;
  geometry::State shape;
  double energy = 0;  ///< elastic [J]
  bool done = false;
  std::string failure;
  const geometry::Ribbon& ribbon() const { return path.ribbon; }
};

/// Takes steps until the path is done or cannot go on.
PathEnd run_path(const geometry::RibbonSpec& spec, const constraint::Surroundings& surroundings,
                 const solver::PathOptions& options);

/// The frame of an undeformed strip: d3 = +x, d1 = +z.
Quat straight_frame();

/// A clamp at a node that stays where it is.
constraint::Support clamp(int node, const Pose& pose);
/// A clamp that moves in a straight line during the path and turns about d3.
constraint::Support moving_clamp(int node, const Pose& from, const Vec3& to, double turn);

/// Length 1, width 0.1, D = 1, rho = 1, clamped along +x at its start.
PathEnd cantilever(int segments, const Vec3& gravity, double barrier);
/// The same strip with both ends clamped along +x, the end moved to (chord, 0, 0).
PathEnd buckled(int segments, double chord, double barrier);
/// Length 2 pi, width 0.8, ends turned by pi against each other and brought to 0.8 of the length.
PathEnd twist_clamped(int segments, double barrier);
/// Length 2 pi, closed with one half twist.
PathEnd moebius(int segments, double width, double barrier);

/// Constraint errors <= 1e-9 and area error <= 1e-10, and that the path got to its end.
void expect_exact(const PathEnd& end);

/// Does a run under a sanitizer or without optimisation, ten to fifty times as slow, have to make do with less.
bool is_slow_build();

/// Errors fall at an observed order of at least 1.8 as segments double.
void expect_second_order(const std::vector<double>& errors);

}  // namespace wunderlich::testing
