// Constraints: how many rows, what they mean, and when they vanish.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random_state.hpp"
#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/constraint/holding.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using geometry::Ribbon;
using geometry::RibbonSpec;
using geometry::State;

/// A chain folded along its rulings: every hinge turns about (0, 1, eta).
State folded(const Ribbon& ribbon) {
  State state = straight_state(ribbon);
  for (std::size_t i = 0; i < state.eta.size(); ++i) state.eta[i] = 0.4 * std::sin(3.0 * static_cast<double>(i));
  state.eta.front() = state.eta.back() = 0;
  Quat frame = ribbon.clamped[0] ? state.end_frame[0] : state.q[0];
  for (std::size_t s = 0; s < state.q.size(); ++s) {
    if (ribbon.hinge_length[s] > 0)
      frame = frame * math::exp_map(0.5 * std::cos(2.0 * static_cast<double>(s)) * Vec3(0, 1, state.eta[s]));
    state.q[s] = frame;
    state.r[s + 1] = state.r[s] + frame * Vec3(0, 0, ribbon.rest_length[s]);
  }
  state.end_frame[1] = frame * math::exp_map(Vec3(0, 0.2, 0));
  return state;
}

template <typename Constraint>
VectorXd residuals(const Ribbon& ribbon, const Constraint& c, const State& state) {
  VectorXd out(rows(ribbon, c));
  residual(ribbon, c, state, out);
  return out;
}

// @eq Shen2015:12, Shen2015:14, Shen2015:15, Shen2015:16
TEST(Constraints, AllVanishOnAChainFoldedAlongItsRulings) {
  for (const auto& [name, ribbon] : sample_ribbons()) {
    if (ribbon.is_loop()) continue;
    SCOPED_TRACE(name);
    const State state = folded(ribbon);
    for (auto measure : {geometry::StrainMeasure::logarithm, geometry::StrainMeasure::printed}) {
      EXPECT_LE(residuals(ribbon, constraint::Binormal{measure}, state).norm(), 1e-13);
      EXPECT_LE(residuals(ribbon, constraint::TorsionMatch{measure}, state).norm(), 1e-13);
    }
    EXPECT_LE(residuals(ribbon, constraint::Length{}, state).norm(), 1e-15);
    EXPECT_LE(residuals(ribbon, constraint::Parallel{}, state).norm(), 1e-14);
    EXPECT_LE(residuals(ribbon, constraint::EndRulings{}, state).norm(), 0);
    EXPECT_GT(residuals(ribbon, constraint::RulingBound{}, state).minCoeff(), 0);
    const ConstraintErrors e = constraint::errors(ribbon, state);
    EXPECT_LE(e.max_length_error + e.max_parallel_error + e.max_binormal + e.max_torsion_mismatch, 1e-13);
    EXPECT_GT(e.max_ruling_ratio, 0.01);
    EXPECT_LT(e.max_ruling_ratio, 1);
  }
}

TEST(Constraints, LeaveTwoFreedomsAHinge) {
  // What remains after the internal constraints: a rigid motion and (kappa, eta) at each hinge.
  for (const auto& [name, ribbon] : sample_ribbons()) {
    SCOPED_TRACE(name);
    int count = rows(ribbon, constraint::Parallel{}) + rows(ribbon, constraint::Binormal{}) +
                rows(ribbon, constraint::TorsionMatch{}) + rows(ribbon, constraint::EndRulings{}) +
                rows(ribbon, constraint::LoopClosure{});
    const int left = geometry::chart_size(ribbon) - count;
    const int n = ribbon.segments;
    const int prescribed = ribbon.clamped[0] + ribbon.clamped[1];
    // The hinge of a clamp adds two equations: its fold is kappa alone, about d2.
    EXPECT_EQ(left, ribbon.is_loop() ? 2 * n : 6 + 2 * (n - 1) - 2 * prescribed);
  }
}

TEST(Constraints, ErrorsAreDimensionlessAndSeparate) {
  RibbonSpec spec;
  spec.length = 2;
  spec.segments = 4;
  const Ribbon ribbon = make_ribbon(spec);
  State state = straight_state(ribbon);
  state.r[4].x() += 0.01;  // one edge of 0.5 longer by 2 %
  EXPECT_NEAR(constraint::errors(ribbon, state).max_length_error, 0.02, 1e-14);
  EXPECT_NEAR(constraint::errors(ribbon, state).max_parallel_error, 0, 1e-14);
  state = straight_state(ribbon);
  state.q[3] = state.q[3] * math::exp_map(Vec3(0.003, 0, 0));
  EXPECT_NEAR(constraint::errors(ribbon, state).max_binormal, 0.003, 1e-14);
  EXPECT_NEAR(constraint::errors(ribbon, state).max_parallel_error, 0.003, 1e-8);
  state = straight_state(ribbon);
  state.q[3] = state.q[3] * math::exp_map(Vec3(0, 0, 0.003));
  EXPECT_NEAR(constraint::errors(ribbon, state).max_torsion_mismatch, 0.003, 1e-14);
  state.eta[2] = 12;  // x = 0.05 * 12 / 0.5
  EXPECT_NEAR(constraint::errors(ribbon, state).max_ruling_ratio, 1.2, 1e-14);
  state.eta[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(constraint::errors(ribbon, state).max_ruling_ratio));
}

// @eq Shen2015:18
TEST(Constraints, TangentTurnIsParallelTransport) {
  const Ribbon ribbon = make_ribbon(RibbonSpec{});
  State state = straight_state(ribbon);
  const Quat reference = math::exp_map(Vec3(0.3, 1.1, -0.4));
  const Vec3 tangent = (reference * math::exp_map(Vec3(0.9, -0.5, 0)) * Vec3::UnitZ()).normalized();
  const Quat carried = constraint::transported(reference, tangent);
  EXPECT_LE((carried * Vec3::UnitZ() - tangent).norm(), 1e-15);
  // The smallest rotation turns about an axis normal to both tangents.
  EXPECT_NEAR(math::log_map(carried * reference.conjugate()).dot(tangent), 0, 1e-15);
  for (double turn : {0.0, 0.7, -2.5}) {
    state.q[4] = carried * math::exp_map(Vec3(0, 0, turn));
    EXPECT_NEAR(residuals(ribbon, constraint::TangentTurn{4, reference}, state)[0], turn, 1e-14);
  }
}

TEST(Constraints, FrameClampIsTheRotationFromItsFrame) {
  const Ribbon ribbon = make_ribbon(RibbonSpec{});
  State state = straight_state(ribbon);
  const Quat target = math::exp_map(Vec3(0.3, 1.1, -0.4));
  state.q[4] = target * math::exp_map(Vec3(0.2, -0.1, 0.5));
  EXPECT_LE((residuals(ribbon, constraint::FrameClamp{4, target}, state) - Vec3(0.2, -0.1, 0.5)).norm(), 1e-15);
}

}  // namespace
}  // namespace wunderlich::testing
