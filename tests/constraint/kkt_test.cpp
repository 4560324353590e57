// The oracle in maximal coordinates against solutions known from elsewhere.
#include "support/kkt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/taylor.hpp"
#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/geometry/chart.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using constraint::Orientation;
using constraint::Support;
using Eigen::VectorXd;
using geometry::RibbonSpec;
using geometry::State;

constexpr double kPi = 3.14159265358979323846;

/// A named set of rows of the analytic reference, by value: a range-for over part of a temporary would dangle.
nlohmann::json analytic_rows(const std::string& name) {
  std::ifstream file(WUNDERLICH_SOURCE_DIR "/validation/reference/analytic.json");
  return nlohmann::json::parse(file).at(name).at("rows");
}

Support clamp(int node, const Pose& pose) {
  Support support;
  support.node = node;
  support.motion.keys = {{0, pose, 0}};
  return support;
}

/// Length 1, width 0.1, D = 1, rho = 1, along +x, clamped at the start.
kkt::Problem cantilever(int segments, const Vec3& gravity) {
  RibbonSpec spec;
  spec.segments = segments;
  spec.clamped = {true, false};
  kkt::Problem problem;
  problem.ribbon = make_ribbon(spec);
  problem.surroundings.gravity = gravity;
  problem.surroundings.supports = {clamp(0, {Vec3::Zero(), straight_state(problem.ribbon).end_frame[0]})};
  return problem;
}

/// The planar state whose tangent has turned by `angle(u)` about d2.
template <typename Angle>
State planar(const geometry::Ribbon& ribbon, const Angle& angle) {
  State state = straight_state(ribbon);
  const Quat start = state.q[0];
  for (std::size_t s = 0; s < state.q.size(); ++s) {
    state.q[s] = start * math::exp_map(angle(0.5 * (ribbon.node_u[s] + ribbon.node_u[s + 1])) * Vec3::UnitY());
    state.r[s + 1] = state.r[s] + state.q[s] * Vec3(0, 0, ribbon.rest_length[s]);
  }
  return state;
}

void expect_exact_constraints(const kkt::Problem& problem, const State& state) {
  const ConstraintErrors e = constraint::errors(problem.ribbon, state);
  EXPECT_LE(std::max({e.max_length_error, e.max_parallel_error, e.max_binormal, e.max_torsion_mismatch}), 1e-12);
}

/// The order at which errors fall when segments double.
void expect_second_order(const std::vector<double>& errors) {
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_GE(std::log2(errors[k - 1] / errors[k]), 1.8) << errors[k];
}

TEST(Kkt, HeavyCantileverConvergesAtSecondOrder) {
  for (const auto& row : analytic_rows("a_heavy_cantilever")) {
    const double load = row["G"];
    if (load > 20) continue;
    SCOPED_TRACE(load);
    std::vector<double> drop, energy;
    for (int n : {25, 50, 100}) {
      kkt::Solution solution;
      solution.state = straight_state(cantilever(n, Vec3::Zero()).ribbon);
      kkt::Problem problem;
      for (double part : {0.2, 0.5, 1.0}) {
        problem = cantilever(n, Vec3(0, 0, -part * load));
        solution = kkt::solve(problem, solution.state);
        ASSERT_TRUE(solution.converged) << solution.iterations << " " << solution.last_step;
      }
      expect_exact_constraints(problem, solution.state);
      const Vec3 tip = solution.state.r.back();
      drop.push_back(std::abs(-tip.z() - row["tip_drop"].get<double>()));
      const double elastic = elastic_value(problem.ribbon, problem.model, solution.state);
      energy.push_back(std::abs(elastic / 0.1 - row["elastic_energy_over_B_per_l"].get<double>()));
      EXPECT_NEAR(tip.x(), row["tip_x"].get<double>(), 2.0 / (n * n));
      EXPECT_NEAR(kkt::pin_force(problem, solution, 0).z(), 0.1 * load, 1e-9);  // carries the weight
    }
    EXPECT_LT(drop[1], 4e-4);
    expect_second_order(drop);
    expect_second_order(energy);
  }
}

TEST(Kkt, ClampedClampedStripConvergesAtSecondOrder) {
  for (const auto& row : analytic_rows("b_clamped_clamped")) {
    const double chord = row["chord"];
    if (chord < 0.5) continue;
    SCOPED_TRACE(chord);
    std::vector<double> height, energy, thrust;
    for (int n : {26, 52, 104}) {
      RibbonSpec spec;
      spec.segments = n;
      spec.clamped = {true, true};
      kkt::Problem problem;
      problem.ribbon = make_ribbon(spec);
      const Quat frame = straight_state(problem.ribbon).q[0];
      problem.surroundings.supports = {clamp(0, {Vec3::Zero(), frame}), clamp(n, {Vec3(chord, 0, 0), frame})};
      const double slope = row["max_slope_deg"].get<double>() * kPi / 180;
      const State start = planar(problem.ribbon, [&](double u) { return -slope * std::sin(2 * kPi * u); });
      const kkt::Solution solution = kkt::solve(problem, start);
      ASSERT_TRUE(solution.converged) << solution.iterations << " " << solution.last_step;
      expect_exact_constraints(problem, solution.state);
      height.push_back(
          std::abs(std::abs(solution.state.r[static_cast<std::size_t>(n / 2)].z()) - row["mid_height"].get<double>()));
      energy.push_back(std::abs(elastic_value(problem.ribbon, problem.model, solution.state) / 0.1 -
                                row["energy_l_over_B"].get<double>()));
      thrust.push_back(std::abs(kkt::pin_force(problem, solution, 0).x() / 0.1 - row["P_l2_over_B"].get<double>()));
    }
    expect_second_order(height);
    expect_second_order(energy);
    expect_second_order(thrust);
  }
}

TEST(Kkt, FigureEight) {
  const double exact = 56.219805;
  std::vector<double> errors;
  for (int n : {50, 100, 200}) {
    RibbonSpec spec;
    spec.segments = n;
    spec.width = 1 / (5 * kPi);
    spec.closure = geometry::Closure::loop;
    spec.half_twists = 2;
    kkt::Problem problem;
    problem.ribbon = make_ribbon(spec);
    const State start = planar(problem.ribbon, [](double u) { return 15.1 / (2 * kPi) * std::sin(2 * kPi * u); });
    Support hold = clamp(0, {start.r[0], start.q[0]});
    hold.segment = 0;
    // A uniform planar loop slides along itself at no cost: one more coordinate fixes where it stands.
    Support phase = clamp(n / 2, {start.r[static_cast<std::size_t>(n / 2)], Quat::Identity()});
    phase.orientation = Orientation::free;
    phase.hold_position = {true, false, false};
    problem.surroundings.supports = {hold, phase};
    const kkt::Solution solution = kkt::solve(problem, start);
    ASSERT_TRUE(solution.converged) << solution.iterations << " " << solution.last_step;
    expect_exact_constraints(problem, solution.state);
    EXPECT_LE((solution.state.r.back() - solution.state.r.front()).norm(), 1e-14);
    EXPECT_LE(kkt::pin_force(problem, solution, 0).norm(), 1e-9);  // nothing holds it but itself
    EXPECT_LE(kkt::pin_force(problem, solution, n / 2).norm(), 1e-9);
    const double normalized = elastic_value(problem.ribbon, problem.model, solution.state) / spec.width;
    errors.push_back(std::abs(normalized / exact - 1));
  }
  EXPECT_LE(errors[0], 4e-3);
  EXPECT_LE(errors[1], 1e-3);
  EXPECT_LE(errors[2], 2.5e-4);
  expect_second_order(errors);
}

TEST(Kkt, EndMomentBendsToAnArc) {
  for (auto frame : {constraint::LoadFrame::space, constraint::LoadFrame::material}) {
    kkt::Problem problem = cantilever(40, Vec3::Zero());
    constraint::Load load;
    load.node = 40;
    load.frame = frame;
    const Vec3 axis = straight_state(problem.ribbon).q[0] * Vec3::UnitY();  // d2 stays: planar
    const double moment = 0.1 * kPi / 2;
    load.keys = {{0, Vec3::Zero(), moment * (frame == constraint::LoadFrame::space ? axis : Vec3::UnitY())}};
    problem.surroundings.loads = {load};
    const kkt::Solution solution = kkt::solve(problem, straight_state(problem.ribbon));
    ASSERT_TRUE(solution.converged);
    const auto strain = strains(problem.ribbon, solution.state);
    for (std::size_t i = 0; i < 40; ++i) EXPECT_NEAR(strain.kappa[i], kPi / 2, 1e-10);
    EXPECT_NEAR(solution.state.r.back().x(), 2 / kPi, 1e-3);
  }
}

/// Bent by its weight, then pulled aside: a state that uses every block of the matrix.
kkt::Problem tilted(int segments) {
  const double angle = 0.3;
  return cantilever(segments, 5 * Vec3(0, std::sin(angle), -std::cos(angle)));
}

kkt::Solution solve_tilted(const kkt::Problem& problem) {
  kkt::Solution solution;
  solution.state = straight_state(problem.ribbon);
  const int steps = 12;
  for (int k = 0; k <= steps; ++k) {
    kkt::Problem part = problem;
    const double fraction = static_cast<double>(k) / steps;
    part.surroundings.gravity = Vec3(0, fraction * problem.surroundings.gravity.y(), problem.surroundings.gravity.z());
    part.barrier = std::max(problem.barrier, 1e-3);
    solution = kkt::solve(part, solution.state);
    if (!solution.converged) return solution;
  }
  return kkt::solve(problem, solution.state);
}

TEST(Kkt, ResponseIsTheDerivativeOfTheEquilibrium) {
  kkt::Problem problem = tilted(24);
  problem.barrier = 1e-3;
  const kkt::Solution solution = solve_tilted(problem);
  ASSERT_TRUE(solution.converged) << solution.iterations << " " << solution.last_step;
  expect_exact_constraints(problem, solution.state);
  EXPECT_GT(std::abs(solution.state.r.back().y()), 1e-3);
  const Vec3 force(0.3, -0.5, 0.4);
  VectorXd right = VectorXd::Zero(geometry::chart_size(problem.ribbon));
  right.segment<3>(geometry::r_index(17)) = force;
  const kkt::Response seen = kkt::response(problem, solution, right);
  const auto pulled = [&](double h) {
    kkt::Problem other = problem;
    constraint::Load load;
    load.node = 17;
    load.keys = {{0, h * force, Vec3::Zero()}};
    other.surroundings.loads = {load};
    const kkt::Solution moved = kkt::solve(other, solution.state);
    EXPECT_TRUE(moved.converged);
    return moved.state;
  };
  const double h = 1e-4;
  const State plus = pulled(h), minus = pulled(-h);
  const auto kappa_plus = strains(problem.ribbon, plus).kappa, kappa_minus = strains(problem.ribbon, minus).kappa;
  const double size = seen.chart.lpNorm<Eigen::Infinity>();
  EXPECT_GT(size, 0.01);
  for (std::size_t i = 0; i < plus.r.size(); ++i) {
    const auto node = static_cast<int>(i);
    const Vec3 dr = (plus.r[i] - minus.r[i]) / (2 * h);
    EXPECT_LE((dr - seen.chart.segment<3>(geometry::r_index(node))).norm(), 1e-5 * size);
    EXPECT_NEAR((plus.eta[i] - minus.eta[i]) / (2 * h), seen.chart[geometry::eta_index(node)], 1e-5 * size);
    EXPECT_NEAR((kappa_plus[i] - kappa_minus[i]) / (2 * h), seen.kappa[i], 1e-5 * size);
  }
}

TEST(Kkt, InertiaCountsTheBucklingModesOfAHeavyColumn) {
  // An upright strip under its own weight: Euler loads G = rho g l^3/D of a clamped-free column are 7.837 and 55.98
  // (Greenhill 1881).
  for (const auto& [load, negative] : std::vector<std::pair<double, int>>{{7.7, 0}, {8.0, 1}, {55.0, 1}, {57.0, 2}}) {
    SCOPED_TRACE(load);
    const kkt::Problem problem = cantilever(60, Vec3(-load, 0, 0));
    const kkt::Solution solution = kkt::solve(problem, straight_state(problem.ribbon));
    ASSERT_TRUE(solution.converged);
    const kkt::Inertia inertia = kkt::inertia(problem, solution);
    EXPECT_EQ(inertia.rank_loss, 0);
    EXPECT_EQ(inertia.negative, negative);
  }
}

TEST(Kkt, MatrixIsTheDerivativeOfTheResiduals) {
  kkt::Problem problem = tilted(10);
  problem.barrier = 1e-2;
  constraint::Load load;
  load.node = 10;
  load.frame = constraint::LoadFrame::material;
  load.keys = {{0, Vec3(0.02, -0.03, 0.01), Vec3(0.001, 0.004, 0.003)}};
  problem.surroundings.loads = {load};
  const kkt::Solution solution = solve_tilted(problem);
  ASSERT_TRUE(solution.converged) << solution.iterations << " " << solution.last_step;
  const int size = geometry::chart_size(problem.ribbon);
  const kkt::System at = kkt::assemble(problem, solution.state, solution.multipliers);
  VectorXd move = VectorXd::Zero(size + at.residual.size());
  move.head(size) = VectorXd::LinSpaced(size, -1, 1);
  const auto residuals = [&](double h) -> VectorXd {
    State state = solution.state;
    geometry::move(problem.ribbon, h * move.head(size), state);
    const kkt::System system = kkt::assemble(problem, state, solution.multipliers);
    VectorXd out(move.size());
    out << system.gradient, system.residual;
    return out;
  };
  expect_derivative(residuals, at.matrix * move);
}

}  // namespace
}  // namespace wunderlich::testing
