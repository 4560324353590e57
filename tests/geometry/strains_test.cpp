// Rotation maps, strains, node frames and the chart.
#include <gtest/gtest.h>

#include "support/random_state.hpp"
#include "support/recut.hpp"
#include "support/taylor.hpp"
#include "wunderlich/geometry/chart.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using geometry::Hinge;
using geometry::Ribbon;
using geometry::RibbonSpec;
using geometry::State;
using geometry::StrainMeasure;

constexpr double kPi = 3.14159265358979323846;
const Vec3 kAxis = Vec3(0.3, -0.5, 0.7).normalized();

/// Angle of the rotation between two frames, whatever the signs of the quaternions.
double angle_between(const Quat& a, const Quat& b) { return math::log_map(a.conjugate() * b).norm(); }

// A handful of roundings: how the mathematical library computes sines, and where it contracts, differs between
// machines.
TEST(Rotation, LogarithmInvertsTheExponentialUpToPi) {
  for (double angle : {0.0, 1e-200, 1e-12, 1e-5, 3e-5, 0.1, 1.0, 3.0, kPi - 1e-3, kPi - 1e-9}) {
    SCOPED_TRACE(angle);
    const Vec3 v = angle * kAxis;
    const Quat q = math::exp_map(v);
    EXPECT_NEAR(q.norm(), 1, 1e-15);
    EXPECT_LE((math::log_map(q) - v).norm(), 1e-15 * (1 + angle));
    EXPECT_LE((math::log_map(Quat(-3 * q.coeffs())) - v).norm(), 1e-15 * (1 + angle));
    const Mat3 reference = Eigen::AngleAxisd(angle, kAxis).toRotationMatrix();
    EXPECT_LE((q.toRotationMatrix() - reference).norm(), 4e-15);
  }
  EXPECT_NEAR(math::log_map(math::exp_map((kPi + 0.1) * kAxis)).norm(), kPi - 0.1, 4e-15);
}

TEST(Rotation, JacobiansAreTheDerivatives) {
  const Vec3 d(0.4, 0.8, -0.5), y(-0.9, 0.2, 1.1);
  for (double angle : {1e-6, 0.3, 0.49, 0.51, 2.0, 3.1}) {
    SCOPED_TRACE(angle);
    const Vec3 v = angle * kAxis;
    const Quat q = math::exp_map(v);
    const auto right = [&](double h) -> VectorXd { return math::log_map(q.conjugate() * math::exp_map(v + h * d)); };
    expect_derivative(right, math::right_jacobian(v) * d);
    const auto left = [&](double h) -> VectorXd { return math::log_map(math::exp_map(v + h * d) * q.conjugate()); };
    expect_derivative(left, math::left_jacobian(v) * d);
    const auto inverse = [&](double h) -> VectorXd { return math::left_jacobian_inverse(v + h * d) * y; };
    expect_derivative(inverse, math::left_jacobian_inverse_derivative(v, y) * d);
    const auto inverse_right = [&](double h) -> VectorXd { return math::right_jacobian_inverse(v + h * d) * y; };
    expect_derivative(inverse_right, math::right_jacobian_inverse_derivative(v, y) * d);
    EXPECT_LE((math::left_jacobian(v) * math::left_jacobian_inverse(v) - Mat3::Identity()).norm(), 2e-15);
    EXPECT_LE((math::right_jacobian(v) * math::right_jacobian_inverse(v) - Mat3::Identity()).norm(), 2e-15);
  }
}

// @eq Shen2015:7
TEST(Strains, StraightStripAlongX) {
  const Ribbon ribbon = make_ribbon(RibbonSpec{});
  const State state = straight_state(ribbon);
  const Mat3 frame = state.q[7].toRotationMatrix();
  EXPECT_LE((frame.col(0) - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LE((frame.col(1) - Vec3(0, -1, 0)).norm(), 1e-15);
  EXPECT_LE((frame.col(2) - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(state.r.back().x(), ribbon.length, 1e-15);
}

/// kappa = d3'.d1, tau = d1'.d2, gamma = d2'.d3 by differences of the frame vectors themselves.
// @eq Shen2015:9
TEST(Strains, AreTheRatesOfTheFrameVectors) {
  const double h = 1e-5;
  const Quat a = math::exp_map(0.8 * kAxis);
  const Vec3 u(0.3, -1.7, 2.2);
  const Mat3 before = a.toRotationMatrix(), after = (a * math::exp_map(h * u)).toRotationMatrix();
  const Mat3 rate = (after - before) / h, mean = 0.5 * (after + before);
  for (StrainMeasure measure : {StrainMeasure::logarithm, StrainMeasure::printed}) {
    const Vec3 strain = geometry::hinge_strain(a, a * math::exp_map(h * u), h, measure);
    EXPECT_NEAR(strain[0], rate.col(1).dot(mean.col(2)), 1e-9);
    EXPECT_NEAR(strain[1], rate.col(2).dot(mean.col(0)), 1e-9);
    EXPECT_NEAR(strain[2], rate.col(0).dot(mean.col(1)), 1e-9);
    EXPECT_LE((strain - u).norm(), 1e-9);
  }
}

/// The paper's matrices B_k, applied as printed to the mean and the difference of two quaternions.
// @eq Shen2015:9, Shen2015:10
TEST(Strains, PrintedMeasureIsThePrintedFormula) {
  const Quat a = math::exp_map(1.1 * kAxis), b = a * math::exp_map(Vec3(0.3, 0.5, -0.4));
  const double h = 0.13;
  const Vec4 slope = (b.coeffs() - a.coeffs()) / h, q = 0.5 * (a.coeffs() + b.coeffs());
  const Vec4 b1(q[3], q[2], -q[1], -q[0]), b2(-q[2], q[3], q[0], -q[1]), b3(q[1], -q[0], q[3], -q[2]);
  const Vec3 expected(2 * b1.dot(slope), 2 * b2.dot(slope), 2 * b3.dot(slope));
  EXPECT_LE((geometry::hinge_strain(a, b, h, StrainMeasure::printed) - expected).norm(), 1e-14);
  const Quat flipped(-b.w(), -b.x(), -b.y(), -b.z());
  EXPECT_LE((geometry::hinge_strain(a, flipped, h, StrainMeasure::printed) - expected).norm(), 1e-14);
}

TEST(Strains, ClampedEndsHaveHalfCellsAndFreeEndsNone) {
  RibbonSpec spec;
  spec.segments = 4;
  spec.clamped = {true, false};
  const Ribbon ribbon = make_ribbon(spec);
  State state = straight_state(ribbon);
  state.end_frame[0] = state.end_frame[0] * math::exp_map(Vec3(0, -0.1, -0.05));
  state.end_frame[1] = state.end_frame[1] * math::exp_map(Vec3(0, 1, 1));
  const auto seen = strains(ribbon, state);
  const Vec3 expected = Vec3(0, 0.1, 0.05) / 0.125;
  EXPECT_NEAR(seen.kappa[0], expected[1], 1e-14);
  EXPECT_NEAR(seen.tau[0], expected[2], 1e-14);
  EXPECT_EQ(seen.kappa[4], 0);
  EXPECT_EQ(seen.tau[4], 0);
}

TEST(Strains, RulingRatioIsOnSegments) {
  RibbonSpec spec;
  spec.length = 3;
  spec.width = 0.5;
  spec.segments = 2;
  spec.spacing = {1, 2};
  const Ribbon ribbon = make_ribbon(spec);
  State state = straight_state(ribbon);
  state.eta = {0.1, 0.5, -0.1};
  const auto seen = strains(ribbon, state);
  EXPECT_NEAR(seen.eta_prime[0], 0.4, 1e-15);
  EXPECT_NEAR(seen.eta_prime[1], -0.3, 1e-15);
  EXPECT_NEAR(seen.ruling_ratio[1], -0.075, 1e-15);
}

/// Cutting a loop elsewhere must show every strain again, reversed where it is now seen from the other side.
// @eq Shen2015:6.2
TEST(Strains, DoNotDependOnWhereALoopIsCut) {
  std::mt19937 random(5);
  for (const auto& [name, ribbon] : sample_ribbons()) {
    if (!ribbon.is_loop()) continue;
    SCOPED_TRACE(name);
    const State state = random_state(ribbon, random);
    for (StrainMeasure measure : {StrainMeasure::logarithm, StrainMeasure::printed}) {
      const auto first = strains(ribbon, state, measure);
      for (int node : {1, 4}) {
        const auto second = strains(recut(ribbon, node), recut(ribbon, state, node), measure);
        for (int k = 0; k <= ribbon.segments; ++k) {
          const auto to = static_cast<std::size_t>(k), from = static_cast<std::size_t>((k + node) % ribbon.segments);
          const double sign = k + node >= ribbon.segments ? ribbon.seam_sign() : 1;
          EXPECT_NEAR(second.gamma[to], sign * first.gamma[from], 1e-12);
          EXPECT_NEAR(second.kappa[to], sign * first.kappa[from], 1e-12);
          EXPECT_NEAR(second.tau[to], first.tau[from], 1e-12);
          const Quat before = node_frame(ribbon, state, static_cast<int>(from));
          const Quat expected = k + node >= ribbon.segments ? across_seam(ribbon, before) : before;
          EXPECT_LE(angle_between(node_frame(recut(ribbon, node), recut(ribbon, state, node), k), expected), 1e-13);
        }
      }
    }
  }
}

TEST(Strains, NodeFramesOfAHelixAreExact) {
  RibbonSpec spec;
  spec.segments = 5;
  spec.spacing = {1, 2, 0.5, 1, 3};
  spec.clamped = {true, true};
  const Ribbon ribbon = make_ribbon(spec);
  State state = straight_state(ribbon);
  const auto frame_at = [&](double u) { return state.end_frame[0] * math::exp_map(u * Vec3(0, 3, 1)); };
  for (std::size_t s = 0; s < 5; ++s) state.q[s] = frame_at(0.5 * (ribbon.node_u[s] + ribbon.node_u[s + 1]));
  state.end_frame[1] = frame_at(ribbon.length);
  for (int i = 0; i <= 5; ++i) {
    EXPECT_LE(angle_between(node_frame(ribbon, state, i), frame_at(ribbon.node_u[static_cast<std::size_t>(i)])), 1e-14);
  }
}

TEST(Chart, StrainDerivativesOfEveryHinge) {
  std::mt19937 random(6);
  const Vec3 weight(0.7, -1.3, 0.4);
  for (const auto& [name, ribbon] : sample_ribbons()) {
    const State state = random_state(ribbon, random);
    const VectorXd d = random_direction(ribbon, random);
    const auto theta = [&](int segment) -> Vec3 {
      return segment < 0 ? Vec3(Vec3::Zero()) : Vec3(d.segment<3>(geometry::theta_index(segment)));
    };
    for (const Hinge& hinge : geometry::hinges(ribbon)) {
      for (StrainMeasure measure : {StrainMeasure::logarithm, StrainMeasure::printed}) {
        SCOPED_TRACE(name + ", node " + std::to_string(hinge.node));
        const Vec3 a = theta(hinge.before), b = theta(hinge.after);
        const auto jet_at = [&, &strip = ribbon](double h) {
          return hinge_jet(strip, moved(strip, state, h * d), hinge, measure);
        };
        const auto strain = [&](double h) -> VectorXd { return jet_at(h).strain; };
        expect_derivative(strain, jet_at(0).before * a + jet_at(0).after * b);
        const auto slope = [&](double h) -> VectorXd {
          VectorXd out(6);
          out << math::right_jacobian(h * a).transpose() * jet_at(h).before.transpose() * weight,
              math::right_jacobian(h * b).transpose() * jet_at(h).after.transpose() * weight;
          return out;
        };
        const auto second = hinge_hessian(ribbon, state, hinge, measure, weight);
        VectorXd expected(6);
        expected << second.before_before * a + second.before_after * b,
            second.before_after.transpose() * a + second.after_after * b;
        // Where an end frame is prescribed its half of the gradient still moves, but is nobody's derivative.
        if (hinge.before < 0) expected.head<3>() = second.before_after * b;
        expect_derivative(slope, expected);
      }
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
