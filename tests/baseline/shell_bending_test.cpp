// The quadratic bending of both shells against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "baseline/shells.hpp"
#include "support/taylor.hpp"
#include "wunderlich/baseline/shell/bending.hpp"
#include "wunderlich/baseline/shell/measure.hpp"

namespace wunderlich::baseline::shell {

namespace {

class ShellBending : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Both, ShellBending, ::testing::Values(Kind::conforming, Kind::nonconforming));

geometry::RibbonSpec strip_of(double length, double width, double stiffness) {
  geometry::RibbonSpec strip;
  strip.length = length;
  strip.width = width;
  strip.bending_stiffness = stiffness;
  return strip;
}

Vec3 on_cylinder(const Vec2& flat) { return {std::sin(flat.x()), -flat.y(), 1 - std::cos(flat.x())}; }

// Folded along the transverse line u = 0.5 by 0.7.
Vec3 folded(const Vec2& flat) {
  const double beyond = std::max(0.0, flat.x() - 0.5);
  return {flat.x() - beyond + beyond * std::cos(0.7), -flat.y(), beyond * std::sin(0.7)};
}

TEST_P(ShellBending, DerivativesAreThoseOfTheEnergy) {  // @eq Wardetzky2007
  const Shell shell = make(GetParam(), strip_of(1, 0.3, 2), 5, 3);
  const Points x = shaken(shell, 1, 0.1), direction = shaken(shell, 2, 1);
  const Points gradient = shell.bending * x;
  const auto energy = [&](double h) { return Eigen::VectorXd::Constant(1, bending_energy(shell, x + h * direction)); };
  testing::expect_derivative(energy, Eigen::VectorXd::Constant(1, gradient.cwiseProduct(direction).sum()));
  // The Hessian is constant: second differences are exact at any distance and the same everywhere.
  const double at_x =
      bending_energy(shell, x + direction) - 2 * bending_energy(shell, x) + bending_energy(shell, x - direction);
  const double at_0 = 2 * bending_energy(shell, direction);
  EXPECT_GT(at_0, 1);
  EXPECT_NEAR(at_x, at_0, 1e-10 * at_0);
}

TEST_P(ShellBending, RigidMotionsChangeNothing) {
  const Shell shell = make(GetParam(), strip_of(1, 0.3, 2), 6, 4);
  const Points x = shaken(shell, 3, 0.1);
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Points moved = (x * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2);
  EXPECT_GT(bending_energy(shell, x), 1);
  EXPECT_NEAR(bending_energy(shell, moved), bending_energy(shell, x), 1e-10 * bending_energy(shell, x));
  EXPECT_NEAR(bending_energy(shell, straight_points(shell)), 0, 1e-9);
}

// One fold by theta stores (D/2) share (2 sin(theta/2) |e|)^2 / A at each of its edges.
TEST_P(ShellBending, AFoldHasTheEnergyOfItsAngle) {  // @eq Bergou2006
  const bool conforming = GetParam() == Kind::conforming;
  const Shell shell = make(GetParam(), strip_of(1, 0.3, 2), 5, 4);
  const double edge = 0.1, area = 0.25 * 0.1, share = conforming ? 1 : 3;
  const double fold = 2 * std::sin(0.35) * edge;
  EXPECT_NEAR(bending_energy(shell, placed(shell, GetParam(), folded)), 3 * 0.5 * 2 * share * fold * fold / area,
              1e-10);
}

// Bent along its length a strip has D/2 kappa^2 l w. Chords are shorter than arcs, so triangles shrink by `chord`.
TEST(ShellBendingConforming, ACylinderConvergesToSecondOrder) {
  std::vector<double> errors;
  for (const int along : {6, 11, 21}) {
    const Shell shell = make(Kind::conforming, strip_of(1, 0.2, 2), along, 4);
    const double energy = bending_energy(shell, placed(shell, Kind::conforming, on_cylinder));
    errors.push_back(energy / (0.5 * 2 * 0.2 * (along - 2) / (along - 1)) - 1);
  }
  EXPECT_LT(std::abs(errors[2]), 5e-4);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.05);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.05);
}

// The hinge at a clamp stands for half a cell, and so for half the turn of a whole one: it counts twice.
TEST(ShellBendingConforming, AClampIsAHingeOfHalfACell) {
  geometry::RibbonSpec strip = strip_of(1, 0.2, 2);
  const Shell open = make(Kind::conforming, strip, 11, 4);
  strip.clamped = {true, true};
  const Shell clamped = make(Kind::conforming, strip, 11, 4);
  const double inner = bending_energy(open, placed(open, Kind::conforming, on_cylinder)) / 9;
  EXPECT_NEAR(bending_energy(clamped, placed(clamped, Kind::conforming, on_cylinder)), (9 + 2 * 2) * inner, 1e-10);
}

// Of z = (a u^2 + c v^2)/2 + b u v the edges together see the mean curvature a + c and nothing of the twist b: of a
// cell each of them a share, in a nonconforming shell the diagonal (a + c)/2, the others a/2 and c/2.
Vec3 quadratic(const Vec2& flat) {
  return {flat.x(), -flat.y(), 0.5 * (3 * flat.x() * flat.x() + 5 * flat.y() * flat.y()) + 7 * flat.x() * flat.y()};
}

TEST(ShellBendingNonconforming, QuadraticsPassThePatchTest) {  // @eq English2008
  const int n = 7, m = 5;
  const Shell shell = make(Kind::nonconforming, strip_of(1, 0.3, 1), n, m);
  Points x(shell.point_count(), 3);
  for (int p = 0; p < shell.point_count(); ++p)
    x.row(p) = quadratic(shell.flat[static_cast<std::size_t>(p)]).transpose();
  const double cell = shell.mesh.cell_length * shell.mesh.cell_width;
  int edges = 0;
  for (std::size_t e = 0; e < shell.mesh.edges.size(); ++e) {
    const Edge& edge = shell.mesh.edges[e];
    if (edge.triangles[1] < 0) continue;
    const Stencil h = midpoint_stencil(shell.mesh, static_cast<int>(e));
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < h.points.size(); ++k) sum += h.weights[k] * Vec3(x.row(h.points[k]));
    const bool transverse = edge.ends[0] / m == edge.ends[1] / m;
    const double expected = edge.diagonal ? 3 + 5 : transverse ? 3 : 5;
    EXPECT_LT((sum.cwiseAbs() - Vec3(0, 0, cell * expected / 2)).norm(), 1e-12) << e;
    ++edges;
  }
  EXPECT_EQ(edges, (n - 2) * (m - 1) + (n - 1) * (m - 2) + (n - 1) * (m - 1));
}

/// First frequency of small transverse vibrations of a cantilever whose columns stay straight [1/s].
double first_frequency(int along) {
  geometry::RibbonSpec strip = strip_of(1, 0.1, 1);
  strip.clamped = {true, false};
  const int across = 3;
  const Shell shell = make(Kind::conforming, strip, along, across);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(shell.point_count(), along - 1);
  for (int p = 2 * across; p < shell.point_count(); ++p) columns(p, p / across - 2) = 1;
  const Eigen::MatrixXd stiffness = columns.transpose() * Eigen::MatrixXd(shell.bending) * columns;
  const Eigen::VectorXd mass = Eigen::Map<const Eigen::VectorXd>(shell.mass.data(), shell.point_count());
  const Eigen::MatrixXd inertia = columns.transpose() * mass.asDiagonal() * columns;
  return std::sqrt(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, inertia).eigenvalues()[0]);
}

// 1.8751^2 sqrt(D/(rho L^4)), Euler and Bernoulli. (Columns that may bend make it softer: docs/baselines.md.)
TEST(ShellBendingConforming, ACantileverVibratesAtItsFrequencyToSecondOrder) {
  const double exact = std::pow(1.875104068711961, 2);
  std::vector<double> errors;
  for (const int along : {11, 21, 41}) errors.push_back(first_frequency(along) / exact - 1);
  EXPECT_LT(std::abs(errors[2]), 1e-3);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.15);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.15);
}

}  // namespace

}  // namespace wunderlich::baseline::shell
