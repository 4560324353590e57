// The figures of the foundation: convergence of equilibria to independent solutions (validation/reference).
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "solver/paths.hpp"
#include "solver/reference.hpp"
#include "wunderlich/geometry/topology.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kBarrier = 1e-9;

void print(const std::string& what, int n, double error) {
  std::cout << "  " << what << ", n = " << n << ": " << error << "\n";
}

TEST(Figures, HeavyCantilever) {
  const auto rows = reference("analytic.json").at("a_heavy_cantilever").at("rows");
  for (const auto& row : rows) {
    const double load = row.at("G");
    SCOPED_TRACE(load);
    std::vector<double> drop, reach, energy;
    for (int n : {50, 100, 200}) {
      const PathEnd end = cantilever(n, Vec3(0, 0, -load), kBarrier);
      expect_exact(end);
      EXPECT_EQ(end.at.negative_modes, 0);
      const Vec3 tip = end.shape.r.back();
      drop.push_back(std::abs(-tip.z() - row.at("tip_drop").get<double>()));
      reach.push_back(std::abs(tip.x() - row.at("tip_x").get<double>()));
      energy.push_back(std::abs(end.energy / 0.1 - row.at("elastic_energy_over_B_per_l").get<double>()));
      print("cantilever G = " + std::to_string(static_cast<int>(load)) + ", tip drop / l", n, drop.back());
    }
    expect_second_order(drop);
    expect_second_order(reach);
    expect_second_order(energy);
  }
}

TEST(Figures, ClampedClampedStrip) {
  const auto rows = reference("analytic.json").at("b_clamped_clamped").at("rows");
  for (const auto& row : rows) {
    const double chord = row.at("chord");
    SCOPED_TRACE(chord);
    std::vector<double> height, energy, thrust;
    for (int n : {26, 52, 104}) {
      const PathEnd end = buckled(n, chord, kBarrier);
      expect_exact(end);
      solver::NewtonWorkspace work;
      const double push = solver::end_reactions(end.path, end.at, work).force[0].x() / 0.1;
      const double middle = std::abs(end.shape.r[static_cast<std::size_t>(n / 2)].z());
      height.push_back(std::abs(middle - row.at("mid_height").get<double>()));
      energy.push_back(std::abs(end.energy / 0.1 - row.at("energy_l_over_B").get<double>()));
      thrust.push_back(std::abs(push - row.at("P_l2_over_B").get<double>()));
      print("clamped at " + std::to_string(chord) + " l, V l/(D w)", n, energy.back());
    }
    expect_second_order(height);
    expect_second_order(energy);
    expect_second_order(thrust);
  }
}

TEST(Figures, RingIsExact) {
  for (int n : {20, 50, 200}) {
    geometry::RibbonSpec spec;
    spec.width = 1 / (5 * kPi);
    spec.segments = n;
    spec.closure = geometry::Closure::loop;
    const PathEnd end = run_path(spec, {}, {});
    expect_exact(end);
    const double error = end.energy / spec.width / (2 * kPi * kPi) - 1;
    print("ring, V relative", n, error);
    EXPECT_LE(std::abs(error), 1e-12);
    for (const double kappa : end.at.chain.kappa) EXPECT_NEAR(kappa, 2 * kPi, 1e-9);
  }
}

/// A Moebius strip seen from its inflection on: kappa >= 0 and tau as in the reference, mirrored if need be.
Profile profile_of(const PathEnd& end) {
  const geometry::Ribbon& ribbon = end.ribbon();
  const auto strain = strains(ribbon, end.shape);
  const auto zeros = geometry::kappa_zeros(ribbon, strain.kappa);
  EXPECT_EQ(zeros.size(), 1u);
  Profile out;
  if (zeros.size() != 1) return out;
  const double start = zeros[0] * ribbon.length;
  // Two turns, the second as seen across the seam.
  const auto n = static_cast<std::size_t>(ribbon.segments);
  for (std::size_t i = 1; i <= 2 * n; ++i) {
    const bool beyond = i > n;
    const std::size_t node = beyond ? i - n : i;
    const double u = ribbon.node_u[node] + (beyond ? ribbon.length : 0) - start;
    if (u < -3 * ribbon.rest_length[0] || u > ribbon.length + 3 * ribbon.rest_length[0]) continue;
    out.u.push_back(u);
    out.kappa.push_back((beyond ? ribbon.seam_sign() : 1) * strain.kappa[node]);
    out.tau.push_back(strain.tau[node]);
  }
  const double middle = 0.5 * ribbon.length;
  const double side = interpolate(out.u, out.kappa, middle) > 0 ? 1 : -1;
  const double hand = interpolate(out.u, out.tau, middle) < 0 ? 1 : -1;
  for (double& kappa : out.kappa) kappa *= side;
  for (double& tau : out.tau) tau *= hand;
  return out;
}

double profile_error(const Profile& seen, const Profile& exact) {
  double most = 0;
  for (std::size_t i = 0; i < exact.u.size(); ++i) {
    const double u = exact.u[i], away = 0.03 * 2 * kPi;
    if (u < away || u > 2 * kPi - away) continue;
    most = std::max(most, std::abs(interpolate(seen.u, seen.kappa, u) - exact.kappa[i]));
    most = std::max(most, std::abs(interpolate(seen.u, seen.tau, u) - exact.tau[i]));
  }
  return most;
}

// @eq Shen2015:3 @eq Shen2015:6.2
TEST(Figures, Moebius) {
  const auto exact = reference("moebius_5pi.json");
  const Profile exact_profile = reference_profile();
  struct Row {
    int n;
    double energy, strain, profile;
  };
  for (const Row& row : {Row{50, 4e-3, 2.5e-3, 5e-2}, Row{100, 1e-3, 6e-4, 1e-2}, Row{200, 2.5e-4, 1.5e-4, 3e-3},
                         Row{400, 6e-5, 4e-5, 3e-3}}) {
    SCOPED_TRACE(row.n);
    const PathEnd end = moebius(row.n, 0.4, kBarrier);
    expect_exact(end);
    EXPECT_EQ(end.at.negative_modes, 0);
    const double energy = end.energy / 0.4 / exact.at("V_over_Dw_L2pi").get<double>() - 1;
    const Profile seen = profile_of(end);
    ASSERT_FALSE(seen.u.empty());
    const double kappa = interpolate(seen.u, seen.kappa, kPi) / exact.at("kappa_opposite_L2pi").get<double>() - 1;
    const double tau = interpolate(seen.u, seen.tau, kPi) / exact.at("tau_opposite_L2pi").get<double>() - 1;
    const double profile = profile_error(seen, exact_profile);
    print("Moebius 5 pi, V relative", row.n, energy);
    print("Moebius 5 pi, kappa opposite, relative", row.n, kappa);
    print("Moebius 5 pi, tau opposite, relative", row.n, tau);
    print("Moebius 5 pi, profile", row.n, profile);
    EXPECT_LE(std::abs(energy), row.energy);
    EXPECT_LE(std::abs(kappa), row.strain);
    EXPECT_LE(std::abs(tau), row.strain);
    EXPECT_LE(profile, row.profile);
  }
}

TEST(Figures, TwistClamped) {
  const double exact = 7.3998594;  // V/(D w), of the solution in twist_pi_Z0.80.csv
  const std::vector<double> zeros{.106335, .360651, .639349, .893665};
  for (const auto& [n, bound] : std::vector<std::pair<int, double>>{{72, 1e-2}, {144, 2.5e-3}}) {
    SCOPED_TRACE(n);
    const PathEnd end = twist_clamped(n, kBarrier);
    expect_exact(end);
    const double error = end.energy / 0.8 / exact - 1;
    print("twist-clamped, V relative", n, error);
    EXPECT_LE(std::abs(error), bound);
    const auto seen = geometry::kappa_zeros(end.ribbon(), strains(end.ribbon(), end.shape).kappa);
    ASSERT_EQ(seen.size(), zeros.size());
    for (std::size_t i = 0; i < zeros.size(); ++i) EXPECT_NEAR(seen[i], zeros[i], 1.0 / n);
  }
}

}  // namespace
}  // namespace wunderlich::testing
