/// What holds a shell: which coordinates of its points are free, which follow a clamp, which are prescribed.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <string>
#include <vector>

#include "wunderlich/baseline/shell/shell.hpp"
#include "wunderlich/constraint/support.hpp"

namespace wunderlich::baseline::shell {

/// Coordinate a of point p is sign[p] q_a[unknown[a][p]] + offset(p, a), or offset(p, a) alone where `unknown` is -1.
/// The points of a clamp that may slide along an axis share one unknown there. So do two points between which a pin
/// stands, one with the sign -1: the pin holds their mean and they turn about it.
struct Hold {
  std::array<std::vector<int>, 3> unknown;
  std::array<int, 3> unknown_count{};
  std::vector<double> sign;                 ///< of the points
  std::array<std::vector<double>, 3> mass;  ///< of the unknowns [kg]

  bool operator==(const Hold&) const = default;
};

/// What the shells do not do of a scene, as a sentence; empty if they do it all.
std::string unsupported(const geometry::RibbonSpec& strip, const constraint::Surroundings& surroundings);

/// Where two supports would hold a coordinate of one point, that as a sentence; else empty.
std::string overlapping(const Shell& shell, const constraint::Surroundings& surroundings);

/// How far a pin or a load is from its place on the strip, at most [m].
double largest_shift(const Shell& shell, const constraint::Surroundings& surroundings);

/// The clamps and pins in force in a step that starts at `time`. A clamp holds the points at and beyond its node if
/// that is an end of the strip, else the columns beside its segment; a pin the point nearest to the centerline at its
/// node, or the mean of two.
Hold make_hold(const Shell& shell, const constraint::Surroundings& surroundings, double time);

/// `offset` at `time` by the supports in force at `start`.
void set_offset(const Shell& shell, const constraint::Surroundings& surroundings, double start, double time,
                Points& offset);

/// The matrix that gives an axis of the points from its unknowns, but for the offset.
Sparse selection(const Hold& hold, std::size_t axis);

/// Adds a change of the unknowns of one axis to the points.
void add_change(const Hold& hold, std::size_t axis, const Eigen::VectorXd& change, Points& x);

/// Forces of gravity and of loads [N]. A load is spread over the points nearest to its node's column, a torque as the
/// smallest forces on them that have it.
void add_loads(const Shell& shell, const constraint::Surroundings& surroundings, const Points& x, double time,
               Points& force);

}  // namespace wunderlich::baseline::shell
