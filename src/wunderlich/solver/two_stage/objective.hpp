/// What stage opt minimises over frames and rulings with the centerline fixed, and the constraints it must keep.
///
/// Unknowns come in blocks, one a node: eta_i, then theta^i of the segment that starts there; a loop's last node is
/// its first. Block b has the unknowns 4 b .. 4 b + 3 and the constraints 2 b, 2 b + 1 of the hinge at its node.
#pragma once

#include "wunderlich/energy/link_terms.hpp"
#include "wunderlich/energy/torsional_inertia.hpp"
#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

/// Share of the way to |w eta' / 2| = 1 that one iteration may go.
inline constexpr double kToBoundary = 0.9;

inline int block_count(const geometry::Ribbon& ribbon) {
  return ribbon.is_loop() ? ribbon.segments : ribbon.node_count();
}
/// Block whose constraints are those of a hinge.
inline int hinge_block(const geometry::Ribbon& ribbon, const geometry::Hinge& hinge) {
  return hinge.node % block_count(ribbon);
}

/// Hinges and what each node shows of them; sizes of the tables.
void set_up_views(const geometry::Ribbon& ribbon, Workspace& work);

/// Recomputes strains, and with `jets` their derivatives.
void refresh_strains(const geometry::Ribbon& ribbon, const energy::Model& model, const geometry::State& shape,
                     bool jets, Workspace& work);

/// (kappa, tau, eta) at the two ends of a link, from the refreshed strains.
energy::Ends link_ends(const geometry::State& shape, const Workspace& work, std::size_t segment);

/// V + E_para + E_I + barrier + proximal term - work of torques [J], at the refreshed strains; infinite where rulings
/// meet.
/// @eq Shen2015:21
double objective_value(const geometry::Ribbon& ribbon, const Options& options, const geometry::State& shape,
                       const Workspace& work);

/// Its gradient by unknown, into work.gradient; needs strains with jets. Held unknowns have 0.
void objective_gradient(const geometry::Ribbon& ribbon, const Options& options, const geometry::State& shape,
                        Workspace& work);

/// Adds a slope in (kappa, tau, eta) as a node shows them to a gradient by unknown.
void add_end_slope(const Workspace& work, std::size_t node, const Vec3& slope, std::vector<double>& out);

/// Makes the entries of held unknowns 0.
void clear_held(const geometry::Ribbon& ribbon, const Workspace& work, std::vector<double>& out);

/// gamma h and (kappa eta - tau) h by hinge [rad], into work.residual; returns the largest.   @eq Shen2015:22
double constraint_residual(const geometry::Ribbon& ribbon, const geometry::State& shape, Workspace& work);

/// What depends on one segment's frame alone: E_para, E_I and torque [J], and its derivatives in theta.
double frame_value(const geometry::Ribbon& ribbon, const geometry::State& shape, const Workspace& work,
                   std::size_t segment);
energy::TurnTerms frame_terms(const geometry::Ribbon& ribbon, const geometry::State& shape, const Workspace& work,
                              std::size_t segment);

/// Stiffness of the proximal term in eta of one block [J]; work.before has the rulings it pulls towards.
double proximal_stiffness(const geometry::Ribbon& ribbon, const OptOptions& options, std::size_t block);

/// Largest |w eta'/2|.
double largest_ruling_ratio(const geometry::Ribbon& ribbon, const geometry::State& shape);

/// Longest share of work.step that keeps turns of frames small and goes at most 0.9 of the way to |x| = 1.
double longest_step(const geometry::Ribbon& ribbon, const geometry::State& shape, const Workspace& work);
/// The same without regard to x; may exceed 1.
double largest_share(const std::vector<double>& step);

/// shape = (q, eta) of the iteration's start moved by `scale` times an increment of the unknowns; held ones stay.
void move_unknowns(const geometry::Ribbon& ribbon, const std::vector<double>& increment, double scale,
                   const Workspace& work, geometry::State& shape);

/// Frames of free ends follow their segments, a loop's last eta its first.
void follow_ends(const geometry::Ribbon& ribbon, geometry::State& shape);

}  // namespace wunderlich::solver::two_stage
