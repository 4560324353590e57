// Jacobians and Hessians of every constraint, at random states that violate it.
#include <gtest/gtest.h>

#include <variant>

#include "support/random_state.hpp"
#include "support/taylor.hpp"
#include "wunderlich/constraint/holding.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using constraint::Binormal;
using constraint::TorsionMatch;
using Eigen::VectorXd;
using geometry::Ribbon;
using geometry::State;
using geometry::StrainMeasure;
using Any = std::variant<constraint::Length, constraint::Parallel, Binormal, TorsionMatch, constraint::RulingBound,
                         constraint::Pin, constraint::FrameClamp, constraint::TangentTurn, constraint::EndRulings,
                         constraint::LoopClosure>;

std::vector<std::pair<std::string, Any>> constraints(const State& state) {
  const Quat near = state.q[2] * math::exp_map(Vec3(0.5, -0.8, 1.2));
  return {{"length", constraint::Length{}},
          {"parallel", constraint::Parallel{}},
          {"binormal", Binormal{}},
          {"binormal, printed", Binormal{StrainMeasure::printed}},
          {"torsion match", TorsionMatch{}},
          {"torsion match, printed", TorsionMatch{StrainMeasure::printed}},
          {"ruling bound", constraint::RulingBound{}},
          {"pin", constraint::Pin{3, Vec3(0.1, 0.2, 0.3)}},
          {"pin of two axes", constraint::Pin{0, Vec3(0.1, 0.2, 0.3), {true, false, true}}},
          {"frame clamp", constraint::FrameClamp{2, near}},
          {"tangent turn", constraint::TangentTurn{2, near}},
          {"end rulings", constraint::EndRulings{}},
          {"loop closure", constraint::LoopClosure{}}};
}

/// Constraints that are linear in the chart: their Jacobian is exact and their Hessian 0.
bool is_linear(const Any& any) {
  return std::holds_alternative<constraint::RulingBound>(any) || std::holds_alternative<constraint::Pin>(any) ||
         std::holds_alternative<constraint::EndRulings>(any) || std::holds_alternative<constraint::LoopClosure>(any);
}

int row_count(const Ribbon& ribbon, const Any& any) {
  return std::visit([&](const auto& c) { return rows(ribbon, c); }, any);
}

VectorXd residuals(const Ribbon& ribbon, const Any& any, const State& state) {
  VectorXd out = VectorXd::Constant(row_count(ribbon, any), 1e300);  // every row must be written
  std::visit([&](const auto& c) { residual(ribbon, c, state, out); }, any);
  return out;
}

Eigen::MatrixXd jacobian(const Ribbon& ribbon, const Any& any, const State& state) {
  geometry::Triplets out;
  std::visit([&](const auto& c) { add_jacobian(ribbon, c, state, 5, out); }, any);
  const int count = row_count(ribbon, any);
  const Eigen::MatrixXd all = dense(5 + count, geometry::chart_size(ribbon), out);
  EXPECT_EQ(all.topRows(5).norm(), 0);
  return all.bottomRows(count);
}

void check(const Ribbon& ribbon, const Any& any, const State& state, const VectorXd& d, const VectorXd& weight) {
  const int size = geometry::chart_size(ribbon);
  const VectorXd slope = jacobian(ribbon, any, state) * d;
  geometry::Triplets triplets;
  std::visit([&](const auto& c) { add_hessian(ribbon, c, state, weight, triplets); }, any);
  if (is_linear(any)) {
    EXPECT_TRUE(triplets.empty());
    EXPECT_GT(slope.norm(), 1e-3);
    const VectorXd change = residuals(ribbon, any, moved(ribbon, state, d)) - residuals(ribbon, any, state);
    EXPECT_LE((change - slope).norm(), 1e-13 * slope.norm());
    return;
  }
  expect_derivative([&](double h) { return residuals(ribbon, any, moved(ribbon, state, h * d)); }, slope);
  const Eigen::MatrixXd hessian = dense(size, size, triplets);
  EXPECT_LE((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
  const auto gradient = [&](double h) {
    const VectorXd here = jacobian(ribbon, any, moved(ribbon, state, h * d)).transpose() * weight;
    return in_first_chart(ribbon, h * d, here);
  };
  if (std::holds_alternative<constraint::Length>(any)) {  // quadratic: the Hessian is exact
    EXPECT_LE((gradient(1) - gradient(0) - hessian * d).norm(), 1e-13 * (hessian * d).norm());
    EXPECT_GT((hessian * d).norm(), 1e-3);
    return;
  }
  expect_derivative(gradient, hessian * d);
}

// @eq Shen2015:12, Shen2015:13, Shen2015:14, Shen2015:15, Shen2015:16, Shen2015:18
TEST(ConstraintDerivatives, OfEveryConstraintOnEveryRibbon) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const auto& [ribbon_name, ribbon] : sample_ribbons()) {
    const State state = random_state(ribbon, random);
    for (const auto& [name, any] : constraints(state)) {
      SCOPED_TRACE(ribbon_name + ", " + name);
      const int count = row_count(ribbon, any);
      if (count == 0) continue;
      VectorXd weight(count);
      for (double& w : weight) w = normal(random);
      const VectorXd d = random_direction(ribbon, random);
      EXPECT_GT(residuals(ribbon, any, state).norm(), 1e-3);
      check(ribbon, any, state, d, weight);
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
