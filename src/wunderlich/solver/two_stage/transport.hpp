/// Time-parallel transport: frames follow their edges from the step's start to its end.
#pragma once

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Which nodes, frames and rulings a drive holds, and the torque on each segment.
void set_up_holding(const geometry::Ribbon& ribbon, const Drive& drive, Workspace& work);

/// Turns every free frame by the smallest rotation from its edge at work.r_start to its edge now, and by
/// `spin` dt about it; the result is also work.carried.   @eq Shen2015:18
void transport_frames(const geometry::Ribbon& ribbon, const std::vector<double>& spin, double dt,
                      geometry::State& shape, Workspace& work);

/// Frames of the supports at the step's end: clamps as prescribed, orientation constraints by the frame carried along
/// with the edge. Of the two quaternions of a frame the one nearer to the frame before.   @eq Shen2015:18
void set_held_frames(const geometry::Ribbon& ribbon, const Drive& drive, const geometry::State& before,
                     geometry::State& shape);

/// Segment whose frame a support holds; -1 for the end node's own.
int held_segment(const geometry::Ribbon& ribbon, const Support& support);

}  // namespace wunderlich::solver::two_stage
