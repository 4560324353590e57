// Facets beside solids of triangles: derivatives, what counts as inside, and ways that are free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/taylor.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/chain_contact.hpp"

namespace wunderlich::testing {
namespace {

using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using math::Vec8;
using solver::MeshPoints;
using solver::MeshProblem;

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  double operator()() { return normal(engine); }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
};

Ribbon strip() {
  geometry::RibbonSpec spec;
  spec.segments = 5;
  spec.length = 1;
  spec.width = 0.3;
  spec.spacing = {1, 1.2, 0.8, 1, 1.5};
  return geometry::make_ribbon(spec);
}

Chain bent(const Ribbon& ribbon, Random& random) {
  Chain chain = geometry::straight_chain(ribbon, {random.vector(), math::exp_map(random.vector())});
  for (int i = 0; i <= ribbon.segments; ++i) {
    const auto node = static_cast<std::size_t>(i);
    if (kappa_is_free(ribbon, i)) chain.kappa[node] = random();
    if (eta_is_free(ribbon, i)) chain.eta[node] = 0.2 * random();
  }
  return chain;
}

/// A box and a wedge beside the middle of a strip, which is within the reach of most of their parts.
MeshProblem two_solids(const Vec3& middle, Random& random) {
  MeshProblem problem;
  problem.distance = 0.6;
  problem.thickness = 0.02;
  problem.stiffness = 3;
  contact::TriangleMesh box = contact::mesh_of(contact::Box{{0.1, 0.07, 0.2}});
  std::vector<Vec3> vertices = box.vertices;
  for (Vec3& v : vertices) v += 0.02 * random.vector();  // no right angles, no equal distances
  for (int i = 0; i < 2; ++i) {
    solver::MeshSolid solid;
    solid.mesh = std::make_shared<const contact::TriangleMesh>(contact::make_mesh(vertices, box.triangles));
    stand({middle + (0.3 + 0.1 * i) * random.vector().normalized(), math::exp_map(random.vector())}, solid);
    problem.solids.push_back(solid);
  }
  return problem;
}

/// One segment's facet moved: its far node, its frame and its rulings.
void move_facet(const Ribbon& ribbon, std::size_t s, const Vec8& by, Chain& chain, Kinematics& k) {
  k.r[s + 1] += by.head<3>();
  k.frame[s] = math::exp_map(by.segment<3>(3)).toRotationMatrix() * k.frame[s];
  k.r[s] = k.r[s + 1] - ribbon.rest_length[s] * k.frame[s].col(2);
  chain.eta[s] += by[6];
  chain.eta[s + 1] += by[7];
}

struct Seen {
  double energy;
  Vec8 gradient;
  math::Mat8 hessian;
  std::array<int, 3> kinds{};  ///< corners, peaks, edges
};

/// Energy and its derivatives, of one segment's pairs alone.
Seen look(const Ribbon& ribbon, const MeshProblem& problem, std::size_t s, const Vec8& by, Chain chain, Kinematics k) {
  move_facet(ribbon, s, by, chain, k);
  MeshPoints points;
  solver::find_mesh_pairs(ribbon, problem, chain, k, points);
  const auto other = [&](const solver::FacetPair& pair) { return pair.segment != s; };
  points.pairs.erase(std::remove_if(points.pairs.begin(), points.pairs.end(), other), points.pairs.end());
  math::ChainSystem system;
  solver::add_mesh_contact(ribbon, problem, chain, k, points, system);
  EXPECT_EQ(system.surfaces.size(), 1u);
  Seen seen{solver::mesh_energy(ribbon, problem, points),
            system.surfaces[0].gradient,
            system.surfaces[0].hessian + system.surfaces[0].geometric,
            {}};
  for (const auto& pair : points.pairs) {
    ++seen.kinds[pair.kind == contact::PairKind::edge_edge ? 2 : pair.corner[0] >= 0 ? 0 : 1];
  }
  return seen;
}

Eigen::VectorXd scalar(double value) { return Eigen::VectorXd::Constant(1, value); }

TEST(MeshContact, HasTheDerivativesOfItsEnergy) {
  Random random{std::mt19937(41), {}};
  const Ribbon ribbon = strip();
  for (int i = 0, tested = 0; tested < 10; ++i) {
    ASSERT_LT(i, 100);
    const std::size_t s = static_cast<std::size_t>(i) % 5;
    SCOPED_TRACE(i);
    const Chain chain = bent(ribbon, random);
    Kinematics k;
    geometry::forward_kinematics(ribbon, chain, k);
    const MeshProblem problem = two_solids(0.5 * (k.r[s] + k.r[s + 1]), random);
    Vec8 way;
    way << random.vector(), random.vector(), random(), random();
    for (int end = 0; end < 2; ++end) {
      if (!geometry::eta_is_free(ribbon, static_cast<int>(s) + end)) way[6 + end] = 0;
    }
    way *= 0.01;
    const auto at = [&](double h) { return look(ribbon, problem, s, h * way, chain, k); };
    const Seen here = at(0);
    if (!std::isfinite(here.energy)) continue;  // the facet is in a solid's thickness
    ++tested;
    for (const int count : here.kinds) EXPECT_GT(count, 0);
    EXPECT_LT((here.hessian - here.hessian.transpose()).norm(), 1e-12 * here.hessian.norm());
    expect_derivative([&](double h) { return scalar(at(h).energy); }, scalar(here.gradient.dot(way)));
    // Turns about one axis add up, so that the slope along the way has the Hessian's derivative.
    expect_derivative([&](double h) { return scalar(at(h).gradient.dot(way)); }, scalar(way.dot(here.hessian * way)));
  }
}

struct Scene {
  Ribbon ribbon = strip();
  MeshProblem problem;
  solver::PairSearch search;
  explicit Scene(const contact::Box& box, const Pose& pose = {}) {
    problem.distance = 0.05;
    problem.stiffness = 1;
    problem.solids.emplace_back();
    problem.solids[0].mesh = std::make_shared<const contact::TriangleMesh>(contact::mesh_of(box));
    stand(pose, problem.solids[0]);
  }
  /// A strip along x from `start`, its width along y.
  MeshPoints points(const Vec3& start) const {
    const Chain chain = geometry::straight_chain(ribbon, {start, math::exp_map(Vec3(0, std::acos(0.0), 0))});
    Kinematics k;
    geometry::forward_kinematics(ribbon, chain, k);
    MeshPoints points;
    solver::find_mesh_pairs(ribbon, problem, chain, k, points);
    return points;
  }
  bool inside(const Vec3& start) const { return is_inside_mesh(problem, points(start)); }
  bool may_go(const Vec3& from, const Vec3& to) { return mesh_may_go(problem, points(from), points(to), search); }
};

TEST(MeshContact, TellsInsideFromOutside) {
  const Scene large({{2, 2, 2}});
  EXPECT_TRUE(large.inside({-0.5, 0, 0}));  // wholly
  EXPECT_TRUE(large.inside({1.5, 0, 0}));   // in part, an end outside
  EXPECT_TRUE(large.inside({-2.5, 0, 0}));  // the other end
  EXPECT_FALSE(large.inside({2.1, 0, 0}));
  EXPECT_FALSE(large.inside({-0.5, 0, 2.01}));
  const Scene needle({{0.01, 0.01, 1}});  // through one facet, past all of its edges
  EXPECT_TRUE(needle.inside({-0.33, 0.05, 0}));
  EXPECT_FALSE(needle.inside({-0.33, 0.3, 0}));
  const Scene bar({{0.01, 1, 0.01}});  // through both rims
  EXPECT_TRUE(bar.inside({-0.33, 0, 0}));
  EXPECT_FALSE(bar.inside({-0.33, 0, 0.02}));
}

TEST(MeshContact, KnowsHowNearItIs) {
  const Scene box({{0.2, 0.1, 0.1}});
  EXPECT_NEAR(mesh_distance(box.problem, box.points({-0.5, 0, 0.13})), 0.03, 1e-14);             // above its face
  EXPECT_NEAR(mesh_distance(box.problem, box.points({0.22, 0, 0.12})), std::sqrt(8e-4), 1e-14);  // off its edge
  const double far = mesh_distance(box.problem, box.points({-0.5, 0, 1.1}));                     // no more than it is
  EXPECT_LE(far, 1 + 1e-14);
  EXPECT_GT(far, 0.99);
}

// The rim of a cylinder's end, which no point of the strip need be near to.
TEST(MeshContact, GoesAroundTheEndsOfACylinder) {
  const contact::Cylinder cylinder{0.05, 0.3};
  for (const int side : {-1, 1}) {
    const contact::TriangleMesh end = contact::end_of(cylinder, side, 1e-3);
    EXPECT_EQ(contact::find_fault(end.vertices, end.triangles).fault, contact::MeshFault::none);
    for (int i = 0; i < 720; ++i) {
      const double angle = i * std::acos(0.0) / 180;
      const Vec3 rim(0.05 * std::cos(angle), 0.05 * std::sin(angle), side * 0.3);
      const double inside = contact::distance(end, rim).value;
      EXPECT_LE(inside, 1e-12);
      EXPECT_GT(inside, -1e-3);
    }
    EXPECT_NEAR(contact::distance(end, {0, 0, side * 0.31}).value, 0.01, 1e-12);
  }
}

TEST(MeshContact, LetsNothingThrough) {
  Scene thin({{0.01, 0.01, 0.01}});
  EXPECT_FALSE(thin.may_go({-0.33, 0.05, 1}, {-0.33, 0.05, -1}));  // inside a facet
  EXPECT_FALSE(thin.may_go({-0.33, 0.15, 1}, {-0.33, 0.15, -1}));  // across a rim
  EXPECT_TRUE(thin.may_go({-0.33, 0.2, 1}, {-0.33, 0.2, -1}));     // past it
  EXPECT_TRUE(thin.may_go({-0.33, 0.05, 1}, {-0.33, 0.05, 0.03}));
  EXPECT_FALSE(thin.may_go({-0.33, 0.05, 0.03}, {-0.33, 0.05, 0.0101}));  // too much of a gap
  EXPECT_TRUE(thin.may_go({-0.33, 0.05, 0.03}, {-0.33, 0.05, 0.02}));
  const MeshPoints below = thin.points({-0.33, 0.05, -1}), beside = thin.points({-0.33, 0.3, -1});
  stand({Vec3(0, 0, -2), Quat::Identity()}, thin.problem.solids[0]);  // the solid goes instead
  EXPECT_FALSE(mesh_may_go(thin.problem, below, thin.points({-0.33, 0.05, -1}), thin.search));
  EXPECT_TRUE(mesh_may_go(thin.problem, beside, thin.points({-0.33, 0.3, -1}), thin.search));
  stand({}, thin.problem.solids[0]);
  thin.problem.thickness = 0.03;
  EXPECT_FALSE(thin.may_go({-0.33, 0.18, 1}, {-0.33, 0.18, -1}));  // past its rim, but not past its thickness
}

}  // namespace
}  // namespace wunderlich::testing
