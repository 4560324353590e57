/// Constraints that a contact changes, linearised in (r, q, eta) together: lengths, gamma = 0, kappa eta = tau, and
/// points of the surface against solids.   @eq Shen2015:6.3
///
/// Unknowns come in blocks of seven, one a node: r_i, eta_i, theta^i of the segment that starts there; a loop's last
/// node is its first. Frames follow their edges by the smallest rotation, and theta is what they turn beside that: a
/// node that is pushed takes the frames of its segments along, as stage opt would make them.   @eq Shen2015:18
#pragma once

#include <array>
#include <vector>

#include "wunderlich/geometry/state.hpp"
#include "wunderlich/math/banded.hpp"
#include "wunderlich/solver/two_stage/types.hpp"

namespace wunderlich::solver::two_stage {

struct Workspace;

using Vec7 = Eigen::Matrix<double, 7, 1>;
inline constexpr int kEtaPlace = 3, kThetaPlace = 4;

/// Slopes of one constraint in the unknowns of the nodes it touches: three at most of an equation, two of a point,
/// six of two edges.
struct Row {
  static constexpr std::size_t kMost = 6;
  std::array<int, kMost> block{-1, -1, -1, -1, -1, -1};  ///< those beyond the last -1
  Eigen::Matrix<double, 7, kMost> slope = Eigen::Matrix<double, 7, kMost>::Zero();
  double residual = 0;
};

/// A point of the surface: at a share of its segment, at v across it.
struct Place {
  std::size_t segment = 0;
  double share = 0;
  double v = 0;  ///< [m]
};

/// An equation of length, binormal or torsion match, and which of its blocks is meant.
struct Touching {
  int row;
  int slot;
};

/// The equations of a state, and the matrix J W^-1 J^T of their range space.
struct Equations {
  std::vector<Vec7> inverse_metric;            ///< (blocks) W^-1; 0 where held
  std::vector<Mat3> follow;                    ///< (segments) turn of the frame, own axes, by motion of its edge [1/m]
  std::vector<Row> rows;                       ///< (3 a block) length/rest - 1, gamma h, (kappa eta - tau) h
  std::vector<std::array<Touching, 8>> touch;  ///< (blocks)
  std::vector<int> touch_count;                ///< (blocks)
  math::BandedMatrix normal;                   ///< factored
  double worst_length = 0, worst_angle = 0;    ///< residuals
};

/// S(u, v) = r + v (d2 + eta d3).   @eq Shen2015:1
Vec3 place_of(const geometry::State& shape, const Place& place);

/// The same with the ruling given: how the material moves while rulings turn.
Vec3 material_place(const geometry::State& shape, const Place& place, double eta);
double eta_at(const geometry::State& shape, const Place& place);

/// W^-1 of a step of length dt [s].
void set_metric(const geometry::Ribbon& ribbon, const Options& options, double dt, Workspace& work);

/// All equations at a state, and how frames follow edges there. False if something is not finite.
bool assemble_equations(const geometry::Ribbon& ribbon, const Options& options, const geometry::State& shape,
                        Workspace& work);
/// Factors their matrix.
bool factor_equations(Workspace& work);

/// Adds the motion of a point along a direction, of any length; with `rulings` also that which turning rulings bring.
void add_point(const geometry::Ribbon& ribbon, const geometry::State& shape, const Place& place, double eta,
               const Vec3& direction, bool rulings, const Workspace& work, Row& row);

/// The bound |x| <= limit of one segment, as limit - |x| >= 0.
void bound_row(const geometry::Ribbon& ribbon, const geometry::State& shape, std::size_t segment, double limit,
               const Workspace& work, Row& row);

/// Moves a shape by share times `motion` (7 a block); frames follow their edges.
void move_all(const geometry::Ribbon& ribbon, const std::vector<Vec7>& motion, double share, Workspace& work,
              geometry::State& shape);

}  // namespace wunderlich::solver::two_stage
