/// What is imposed on a ribbon from outside, and what closes a loop. The shape of the functions is explained in
/// `constraint/internal.hpp`.
#pragma once

#include <array>

#include "wunderlich/constraint/internal.hpp"

namespace wunderlich::constraint {

/// Holds a node at a point, by the world axes chosen [m].
struct Pin {
  int node = 0;
  Vec3 position = Vec3::Zero();
  std::array<bool, 3> axes{true, true, true};
};

/// Holds the whole frame of a segment: the rotation vector from `frame` to the segment's frame, in the axes of
/// `frame` [rad]. (The paper subtracts quaternions: same zeros, but four rows of which one is dependent.)
/// @eq Shen2015:18
struct FrameClamp {
  int segment = 0;
  Quat frame = Quat::Identity();
};

/// Holds a segment's turn about its own tangent and leaves the tangent free: the frame must be `frame`, carried
/// to the segment's tangent by the smallest rotation (parallel transport in time, `frame` being that of the step's
/// start). The residual is the angle between the two about the tangent [rad]. Undefined only where the tangent has
/// turned by pi since then.   @eq Shen2015:18
struct TangentTurn {
  int segment = 0;
  Quat frame = Quat::Identity();
};

/// eta = 0 at both ends of an open strip, which make its ends rectangular; no rows where rulings are free there and
/// in loops.   @eq Shen2015:1
struct EndRulings {};

/// The two ends of a loop are one: r_n - r_0 [m] and eta_n - (+-) eta_0. Frames need nothing of their own: the seam's
/// hinge has a binormal and a torsion constraint like any other. No rows for open strips.   @eq Shen2015:6.2
struct LoopClosure {};

/// A frame carried to another tangent (a unit vector) by the smallest rotation.   @eq Shen2015:18
Quat transported(const Quat& frame, const Vec3& tangent);

/// How many scalar equations.
int rows(const geometry::Ribbon& ribbon, const Pin& c);
int rows(const geometry::Ribbon& ribbon, const FrameClamp&);
int rows(const geometry::Ribbon& ribbon, const TangentTurn&);
int rows(const geometry::Ribbon& ribbon, const EndRulings&);
int rows(const geometry::Ribbon& ribbon, const LoopClosure&);

/// Their values; `out` has `rows` entries.
void residual(const geometry::Ribbon& ribbon, const Pin& c, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const FrameClamp& c, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const TangentTurn& c, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const EndRulings&, const geometry::State& state, ResidualRef out);
void residual(const geometry::Ribbon& ribbon, const LoopClosure&, const geometry::State& state, ResidualRef out);

/// Their derivatives in the chart of `geometry/chart.hpp`, from row `first_row` on.
void add_jacobian(const geometry::Ribbon& ribbon, const Pin& c, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const FrameClamp& c, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const TangentTurn& c, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const EndRulings&, const geometry::State& state, int first_row,
                  Triplets& out);
void add_jacobian(const geometry::Ribbon& ribbon, const LoopClosure&, const geometry::State& state, int first_row,
                  Triplets& out);

/// Second derivatives of the sum of multiplier times residual, in the chart.
void add_hessian(const geometry::Ribbon& ribbon, const Pin& c, const geometry::State& state, MultiplierRef multiplier,
                 Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const FrameClamp& c, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const TangentTurn& c, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const EndRulings&, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);
void add_hessian(const geometry::Ribbon& ribbon, const LoopClosure&, const geometry::State& state,
                 MultiplierRef multiplier, Triplets& out);

}  // namespace wunderlich::constraint
