/// Strips over solids, and how near they come.
#pragma once

#include "implicit/motions.hpp"

namespace wunderlich::testing {

constexpr double kGravity = 9.81;

/// A free strip of 0.3 m x 30 mm, 0.1 kg/m^2 over solids, let go from along x.
Motion drop(double bending_stiffness, int segments, const std::vector<constraint::Obstacle>& solids, const Pose& base,
            const Vec3& gravity);

constraint::Obstacle solid(const contact::Shape& shape, const Pose& pose);

Pose along_x(double x, double z);
Pose axis_y(double x, double z, double turn);

/// Smallest distance of the facets to the solids, by looking at (fine + 1)^2 points of each, apart from the solver's.
double clearance(const Motion& m, int fine = 24);

/// The smallest of them after each step.
double lowest_clearance(double duration, double dt, Motion& m, int fine = 24);

/// What the solids exert on the strip [N].
Vec3 push_of(const solver::PathProblem& path, double t, const geometry::Chain& chain);

}  // namespace wunderlich::testing
