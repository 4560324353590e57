/// What touches in one step: points of the reconstructed surface and round solids, or parts of the surface with one
/// another and with solids of triangles.   @eq Shen2015:6.3
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "wunderlich/constraint/support.hpp"
#include "wunderlich/contact/pair.hpp"
#include "wunderlich/solver/two_stage/contact_rows.hpp"

namespace wunderlich::solver::two_stage {

inline constexpr std::size_t kItself = std::numeric_limits<std::size_t>::max();  ///< in place of a solid: the strip
inline constexpr double kKeeps = 0.25;  ///< of contact.distance: what stays between, beside the thickness

/// A point of the strip as part of a touch.
struct Arm {
  Place place;
  double weight = 1;
  double eta_start = 0;  ///< ruling at the step's start: friction acts on what is fixed to the material
};

/// Parts that may meet, by their points: corners 2i + side of node i of the strip, or vertices of a solid.
struct Pair {
  contact::PairKind kind = contact::PairKind::vertex_triangle;
  std::array<int, 4> corner{-1, -1, -1, -1};
  std::array<int, 4> vertex{-1, -1, -1, -1};
};

/// What pushes in one step. Its gap changes by the normal times the sum of weights times motions of its arms.
struct Touch {
  std::array<Arm, 4> arm;
  std::size_t arm_count = 1;
  std::size_t solid = 0;
  std::optional<Pair> pair;    ///< of a point none
  bool fast = false;           ///< a point that may leap over the solid in this step
  double friction = 0;         ///< Coulomb's coefficient
  Vec3 from = Vec3::Zero();    ///< where it would be had nothing slid, as weights times places [m]
  Vec3 normal = Vec3::Zero();  ///< of the solid, outward; of a pair from its second part to its first
  double gap = 0;              ///< beyond thickness and margin; of a plane that keeps the solid behind it [m]
  double allowed = 0;          ///< gap that may be left: what was inside at the step's start comes out slowly [m]
  double push = 0;             ///< lambda_n so far [N]
  Vec3 drag = Vec3::Zero();    ///< lambda_t so far, in the plane square to the normal [N]
  std::span<const Arm> arms() const { return {arm.data(), arm_count}; }
};

/// What a look at all that may touch found.
struct Nearest {
  double gap = std::numeric_limits<double>::infinity();       ///< smallest that is sure, beyond the thickness: what may
                                                              ///< bulge between points is taken off [m]
  double distance = std::numeric_limits<double>::infinity();  ///< smallest, beyond the thickness [m]
  bool passes = false;                                        ///< parts go through each other on the way
};

/// The surroundings at both ends of a substep that work.before began, and no touches.
void set_surroundings(const geometry::Ribbon& ribbon, const constraint::Surroundings& surroundings, double t0,
                      double t1, Workspace& work);

/// Looks at all that may touch in a shape, and adds what is nearer than it may by more than `tolerance` to the touches.
Nearest find_touches(const geometry::Ribbon& ribbon, const geometry::State& shape, double tolerance, Workspace& work);

/// Normal, gap and arms of a touch in a shape, the last one that was looked at.
void refresh_touch(const geometry::State& shape, const Workspace& work, Touch& touch);

/// What a step leaves of a gap of its start, where that is negative: the touch comes out without being thrown.
double allowed_gap(double start_gap, double width);

/// A point in the frame of a solid, and out of it.
Vec3 into(const Pose& pose, const Vec3& point);
Vec3 out_of(const Pose& pose, const Vec3& point);

}  // namespace wunderlich::solver::two_stage
