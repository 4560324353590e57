/// Rods for tests, and problems that several tests share.
#pragma once

#include <random>

#include "wunderlich/baseline/rod/motion.hpp"

namespace wunderlich::testing {

using baseline::rod::Rod;
namespace rod = baseline::rod;

constexpr double kPi = 3.14159265358979323846;

/// Open and closed with 0, 1, 2 half twists; unequal edges; stiffnesses near one another, so that none hides.
std::vector<Rod> sample_rods();

/// Edges off in length and direction, sections turned at random.
rod::State random_state(const Rod& sample, std::mt19937& random);

/// An increment of every coordinate by about its natural unit, the ends of a loop alike.
std::vector<double> random_increment(const Rod& sample, std::mt19937& random);

/// The frame of a straight rod: d3 = +x, d1 = +z.
Quat straight_frame();

/// A clamp that goes from a pose to a place while load parameter goes from 0 to 1, turning about d3.
constraint::Support clamp(int node, const Pose& from, const Vec3& to, double turn);

/// Problem T: length 1, width 0.1, h = 1e-3, E = 1e9, nu = 0.3; first and last edge clamped, the ends turned by +-pi/2
/// and brought together by 0.05.
geometry::RibbonSpec problem_t_spec(int nodes);
constraint::Surroundings problem_t_surroundings(int nodes);

struct PathEnd {
  rod::State state;
  rod::Report last;
  int iterations = 0;
  bool done = false;
  double energy = 0;  ///< elastic [J]
};
/// Equilibria in equal load steps from `start`, supports at rest there; stops at the first that does not converge.
PathEnd along_path(const Rod& sample, const constraint::Surroundings& surroundings, rod::State start, int steps,
                   const rod::Options& options = {});

}  // namespace wunderlich::testing
