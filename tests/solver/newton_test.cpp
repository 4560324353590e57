// Newton's method: the gradient it works with, and how it ends where there is nothing to find.
#include "wunderlich/solver/newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "solver/paths.hpp"
#include "support/taylor.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using constraint::LoadFrame;
using constraint::Orientation;
using Eigen::Index;
using Eigen::VectorXd;
using geometry::Chain;
using geometry::Kinematics;
using geometry::Ribbon;
using solver::ChainProblem;
using solver::Hold;

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  double operator()() { return normal(engine); }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
};

Ribbon strip(bool loop, int half_twists, std::array<bool, 2> clamped, bool free_rulings) {
  geometry::RibbonSpec spec;
  // 7, 8 or 9 nodes: nodes and links are worked off by fours, and these end the last four differently.
  spec.segments = 6 + (clamped[0] ? 1 : 0) + (clamped[1] ? 1 : 0);
  spec.length = 1.3;
  spec.width = 0.15;
  spec.bending_stiffness = 0.7;
  spec.closure = loop ? geometry::Closure::loop : geometry::Closure::open;
  spec.half_twists = half_twists;
  spec.clamped = clamped;
  spec.free_rulings = free_rulings;
  spec.spacing = {1, 1.2, 0.8, 1, 1.5, 1, 0.9, 1.1};
  spec.spacing.resize(static_cast<std::size_t>(spec.segments));
  return geometry::make_ribbon(spec);
}

Chain random_chain(const Ribbon& ribbon, Random& random) {
  Chain chain = geometry::straight_chain(ribbon, {random.vector(), math::exp_map(random.vector())});
  for (int i = 0; i <= ribbon.segments; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (kappa_is_free(ribbon, i)) chain.kappa[k] = 2 * random();
    if (eta_is_free(ribbon, i)) chain.eta[k] = 0.2 * random();
  }
  return chain;
}

ChainProblem random_problem(const Ribbon& ribbon, const energy::Model& model, Random& random) {
  ChainProblem problem;
  problem.model = model;
  problem.barrier = 0.01;
  for (int i = 0; i <= ribbon.segments; ++i) {
    problem.force.push_back(random.vector());
    problem.anchor.push_back(random.vector());
    problem.tie.push_back(3 + random());
  }
  for (int i = 0; i < ribbon.segments; ++i) {
    Mat3 root, anchor;
    root << random.vector(), random.vector(), random.vector();
    anchor << random.vector(), random.vector(), random.vector();
    problem.turn_tie.push_back(1.5 + random());
    problem.turn_anchor.push_back(random.vector());
    problem.facets.push_back({root * root.transpose(), anchor});
  }
  for (const int segment : {2, 0, ribbon.segments - 1}) {
    const auto s = static_cast<std::size_t>(segment);
    problem.grips.push_back({segment, {problem.facets[s].weight, problem.facets[s == 0 ? 1 : 0].anchor}});
  }
  problem.loads = {{ribbon.segments, LoadFrame::material, random.vector(), random.vector()},
                   {3, LoadFrame::space, random.vector(), random.vector()}};
  return problem;
}

/// Dashpots that have bent since `before`.
void add_viscosity(const Chain& before, ChainProblem& problem) {
  problem.viscosity = 0.8;
  problem.before = &before;
}

/// Holds of every kind. Rows of a whole frame are those of the step to the target, hence gradients where the frame is
/// on its target only: put it there.
void add_holds(const Kinematics& k, Random& random, ChainProblem& problem) {
  const auto last = static_cast<int>(k.r.size()) - 1;
  Hold end{last, {true, true, true}, Orientation::full, {random.vector(), k.q.back()}};
  const Quat off = math::exp_map(0.4 * random.vector());
  Hold turn{5, {false, false, false}, Orientation::about_tangent, {Vec3::Zero(), off * k.q[5]}};
  Hold pin{2, {true, false, true}, Orientation::free, {random.vector(), Quat::Identity()}};
  problem.holds = {end, turn, pin};
}

/// Solids all round, within whose barriers most of the strip is.
void add_solids(const Chain& chain, const Kinematics& k, ChainProblem& problem) {
  const auto at = [&](double x, double y, double z) {
    return Pose{chain.base.position + Vec3(x, y, z), math::exp_map(Vec3(0.3, -1.1, 0.4))};
  };
  solver::ContactProblem& contact = problem.contact;
  contact.solids = {{contact::HalfSpace{}, {chain.base.position - Vec3(0, 0, 4), Quat::Identity()}, 0},
                    {contact::Sphere{1.2}, at(4, 1, 0), 0, 20},
                    {contact::Capsule{0.7, 3}, at(-4, 0, 1), 0, 30}};
  contact.distance = 5;
  contact.thickness = 0.1;
  contact.stiffness = 3;
  contact.width = 0.15;  // the strip's
  contact.along = 2;
  contact.across = 3;
  contact.slip = 0.3;
  for (std::size_t s : {5u, 3u, 2u}) {  // two slide, one sticks
    const double off = s == 2 ? 0.1 : 1;
    solver::Friction friction;
    friction.segment = s;
    friction.along = -0.03;
    friction.across = 0.05;
    friction.from = k.r[s + 1] + off * Vec3(0.5, -0.7, 0.2);
    friction.normal = Vec3(1, 2, -2) / 3;
    friction.force = 1.5;
    contact.friction.push_back(friction);
  }
}

double contact_value(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k) {
  solver::ContactPoints points;
  find_points(ribbon, problem.contact, chain, k, points);
  return contact_energy(ribbon, problem.contact, points) + friction_value(problem.contact, k);
}

void linearise_all(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain, const Kinematics& k,
                   const std::vector<double>& multipliers, math::ChainSystem& system) {
  solver::Touching touching;
  solver::SelfSearch search;
  find_points(ribbon, problem.contact, chain, k, touching.points);
  const solver::StripPlace place{ribbon, chain, k};
  if (problem.self.active()) find_pairs({&place, 1}, problem.self, search, touching.self);
  linearise(ribbon, problem, chain, k, multipliers, touching, system);
}

Chain moved(const Chain& chain, const VectorXd& x) {
  Chain out = chain;
  out.base.position += x.head<3>();
  out.base.frame = math::exp_map(x.segment<3>(3)) * chain.base.frame;
  for (std::size_t i = 0; i < out.kappa.size(); ++i) {
    out.kappa[i] += x[6 + 2 * static_cast<Index>(i)];
    out.eta[i] += x[7 + 2 * static_cast<Index>(i)];
  }
  return out;
}

/// A direction along everything that may move.
VectorXd random_direction(const Ribbon& ribbon, Random& random) {
  VectorXd d = VectorXd::NullaryExpr(6 + 2 * ribbon.node_count(), [&] { return random(); });
  for (int i = 0; i <= ribbon.segments; ++i) {
    if (!kappa_is_free(ribbon, i)) d[6 + 2 * i] = 0;
    d[7 + 2 * i] *= eta_is_free(ribbon, i) ? 0.3 : 0;
  }
  return d;
}

/// d(objective + multipliers . residuals) along d: by the sweep, and as a function to take differences of.
void expect_gradient(const Ribbon& ribbon, const ChainProblem& problem, const Chain& chain,
                     const std::vector<double>& multipliers, Random& random) {
  Kinematics start;
  geometry::forward_kinematics(ribbon, chain, start);
  math::ChainSystem system;
  math::ChainWorkspace work;
  math::ChainStep step;
  linearise_all(ribbon, problem, chain, start, multipliers, system);
  ASSERT_TRUE(chain_step(system, work, step));
  const VectorXd d = random_direction(ribbon, random);
  double slope = work.base_gradient.dot(d.head<6>());
  for (std::size_t i = 0; i < work.gradient.size(); ++i) {
    slope += work.gradient[i].dot(d.segment<2>(6 + 2 * static_cast<Index>(i)));
  }
  const auto value = [&](double h) {
    const Chain at = moved(chain, h * d);
    Kinematics k;
    geometry::forward_kinematics(ribbon, at, k);
    std::vector<double> residuals;
    constraint_residuals(ribbon, problem, at, k, residuals);
    double sum = objective(ribbon, problem, at, k, start).total() + contact_value(ribbon, problem, at, k);
    for (std::size_t i = 0; i < residuals.size(); ++i) sum += multipliers[i] * residuals[i];
    return VectorXd::Constant(1, sum);
  };
  expect_derivative(value, VectorXd::Constant(1, slope));
}

TEST(SweepGradient, IsTheSlopeOfTheObjective) {
  Random random{std::mt19937(1), {}};
  for (const auto elastic : {energy::Elastic::wunderlich, energy::Elastic::truncated, energy::Elastic::sadowsky}) {
    for (const auto strain : {energy::StrainMeasure::logarithm, energy::StrainMeasure::printed}) {
      for (const auto& ribbon : {strip(false, 0, {false, false}, false), strip(false, 0, {true, false}, false),
                                 strip(false, 0, {true, true}, true)}) {
        SCOPED_TRACE(static_cast<int>(elastic) * 10 + static_cast<int>(strain));
        const Chain chain = random_chain(ribbon, random);
        ChainProblem problem = random_problem(ribbon, {elastic, 3, strain}, random);
        const Chain before = random_chain(ribbon, random);
        add_viscosity(before, problem);
        Kinematics here;
        geometry::forward_kinematics(ribbon, chain, here);
        add_solids(chain, here, problem);
        EXPECT_GT(contact_value(ribbon, problem, chain, here), 0);
        expect_gradient(ribbon, problem, chain, {}, random);
        Kinematics k;
        geometry::forward_kinematics(ribbon, chain, k);
        add_holds(k, random, problem);
        std::vector<double> multipliers(row_count(problem));
        for (double& m : multipliers) m = random();
        expect_gradient(ribbon, problem, chain, multipliers, random);
      }
    }
  }
}

TEST(SweepGradient, IsTheSlopeOfAClosedLoop) {
  Random random{std::mt19937(2), {}};
  for (int half_twists : {0, 1, 2}) {
    SCOPED_TRACE(half_twists);
    const Ribbon ribbon = strip(true, half_twists, {}, false);
    const Chain chain = random_chain(ribbon, random);
    ChainProblem problem = random_problem(ribbon, {}, random);
    const Chain before = random_chain(ribbon, random);
    add_viscosity(before, problem);
    problem.loads.clear();
    problem.closed = true;
    std::vector<double> multipliers;
    for (std::size_t i = 0; i < row_count(problem); ++i) {
      multipliers.push_back(i < 3 || i > 5 ? random() : 0);  // the frames are off: see add_holds
    }
    expect_gradient(ribbon, problem, chain, multipliers, random);
  }
}

/// What the step's chart makes of it: the gradient there, and how much of each row of the Hessian times the step is
/// the chart's.
VectorXd of_chart(const math::ChainSystem& system, const VectorXd& gradient, const math::ChainStep& step) {
  VectorXd out = VectorXd::Zero(gradient.size());
  for (std::size_t i = 0; i < step.u.size(); ++i) {
    const Index at = 2 * static_cast<Index>(i);
    const double bend = system.links[i].chart * gradient[at + 1];
    out[at] = bend * step.u[i][1];
    out[at + 1] = bend * step.u[i][0];
  }
  return out;
}

/// Along the Newton step the gradient goes to zero, to first order, but for what its chart bends: so the sweep's
/// Hessian is its derivative.
TEST(SweepHessian, IsTheDerivativeOfTheGradient) {
  Random random{std::mt19937(3), {}};
  for (const auto strain : {energy::StrainMeasure::logarithm, energy::StrainMeasure::printed}) {
    const Ribbon ribbon = strip(false, 0, {true, false}, false);
    const Chain chain = random_chain(ribbon, random), before = random_chain(ribbon, random);
    ChainProblem problem = random_problem(ribbon, {energy::Elastic::wunderlich, 3, strain}, random);
    add_viscosity(before, problem);
    Kinematics here;
    geometry::forward_kinematics(ribbon, chain, here);
    add_solids(chain, here, problem);
    problem.loads.clear();
    problem.base_fixed.fill(true);
    math::ChainSystem system;
    math::ChainWorkspace work;
    math::ChainStep step;
    const auto gradient = [&](const Chain& at) {
      Kinematics k;
      geometry::forward_kinematics(ribbon, at, k);
      linearise_all(ribbon, problem, at, k, {}, system);
      solver::use_torsion_chart(ribbon, at, system);
      EXPECT_TRUE(chain_step(system, work, step));
      VectorXd all(2 * ribbon.node_count());
      for (std::size_t i = 0; i < work.gradient.size(); ++i)
        all.segment<2>(2 * static_cast<Index>(i)) = work.gradient[i];
      return all;
    };
    const VectorXd start = gradient(chain);
    VectorXd d = VectorXd::Zero(6 + 2 * ribbon.node_count());
    for (std::size_t i = 0; i < step.u.size(); ++i) d.segment<2>(6 + 2 * static_cast<Index>(i)) = step.u[i];
    const double size = d.norm();
    const VectorXd slope = of_chart(system, start, step) - start;
    expect_derivative([&](double h) { return gradient(moved(chain, h / size * d)); }, slope / size);
  }
}

/// Newton's method works in curvature and torsion where there is curvature: along straight lines in these the bending
/// energy bends upwards whatever the ruling, along straight lines in curvature and ruling it does not.
TEST(TorsionChart, MakesTheBendingEnergyConvex) {
  const Ribbon ribbon = strip(false, 0, {false, false}, true);
  ChainProblem problem;
  problem.barrier = 0;
  problem.force.assign(static_cast<std::size_t>(ribbon.segments) + 1, Vec3::Zero());
  Random random{std::mt19937(5), {}};
  int concave = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const double eta = 3 * random();  // everywhere: no ruling turns against the next
    Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), straight_frame()});
    chain.kappa.assign(chain.kappa.size(), 4);
    chain.eta.assign(chain.eta.size(), eta);
    for (int i : {0, ribbon.segments})
      if (!kappa_is_free(ribbon, i)) chain.kappa[static_cast<std::size_t>(i)] = 0;
    Kinematics k;
    geometry::forward_kinematics(ribbon, chain, k);
    math::ChainSystem system;
    linearise(ribbon, problem, chain, k, {}, {}, system);
    solver::use_torsion_chart(ribbon, chain, system);
    const math::ChainLink &before = system.links[2], &link = system.links[3];
    Mat2 hessian = before.hess_bb + link.hess_aa;
    concave += hessian.determinant() < 0 ? 1 : 0;
    // The energy along kappa + a, tau + b, with tau = kappa eta, has this second derivative in (a, eta - eta0).
    hessian(0, 1) -= link.chart * (before.grad_b + link.grad_a)[1];
    hessian(1, 0) = hessian(0, 1);
    EXPECT_GT(hessian.determinant(), 0) << "eta " << eta;
    EXPECT_GT(hessian(0, 0), 0);
  }
  EXPECT_GT(concave, 25);
}

/// A strip clamped at its base, with its end held at `target`.
struct Stretched {
  Ribbon ribbon = strip(false, 0, {true, true}, false);
  ChainProblem problem;
  Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), straight_frame()});
  std::vector<double> multipliers = std::vector<double>(6, 0.01);

  explicit Stretched(const Vec3& target) {
    problem.force.assign(9, Vec3::Zero());
    problem.base_fixed.fill(true);
    problem.holds = {{8, {true, true, true}, Orientation::full, {target, straight_frame()}}};
    for (int i = 1; i < 8; ++i) {
      chain.kappa[static_cast<std::size_t>(i)] = 0.2 * i;
      chain.eta[static_cast<std::size_t>(i)] = 0.05 * i;
    }
  }

  /// Runs, and expects that nothing was found and nothing changed.
  void expect_nothing() {
    const Chain before = chain;
    const std::vector<double> lambda = multipliers;
    solver::NewtonWorkspace work;
    const solver::NewtonReport report = minimise(ribbon, problem, {}, chain, multipliers, work);
    EXPECT_FALSE(report.converged());
    EXPECT_EQ(multipliers, lambda);
    EXPECT_EQ(chain.base.position, before.base.position);
    EXPECT_EQ(chain.base.frame.coeffs(), before.base.frame.coeffs());
    // NaN is not equal to itself
    EXPECT_TRUE(std::equal(chain.kappa.begin(), chain.kappa.end(), before.kappa.begin(),
                           [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    EXPECT_EQ(chain.eta, before.eta);
  }
};

TEST(Minimise, FindsWhatThereIs) {
  Stretched strip(Vec3(1, 0.1, 0.05));
  solver::NewtonWorkspace work;
  const solver::NewtonReport report = minimise(strip.ribbon, strip.problem, {}, strip.chain, strip.multipliers, work);
  EXPECT_TRUE(report.converged()) << static_cast<int>(report.outcome) << " " << report.iterations;
  EXPECT_LE(report.max_residual, 1e-9);
  EXPECT_EQ(report.negative_modes, 0);
  Kinematics k;
  geometry::forward_kinematics(strip.ribbon, strip.chain, k);
  EXPECT_LE((k.r.back() - Vec3(1, 0.1, 0.05)).norm(), 1e-9);
}

TEST(Minimise, SaysSoWhereClampsAskForMoreThanTheLength) {
  Stretched(Vec3(1.31, 0, 0)).expect_nothing();
  Stretched(Vec3(2, 0, 0)).expect_nothing();
}

TEST(Minimise, NeverConvergesOnNoNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 target(1, 0.1, 0.05);
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    Stretched force(target);
    force.problem.force[4].y() = bad;
    force.expect_nothing();
    Stretched(Vec3(1, bad, 0)).expect_nothing();
    Stretched start(target);
    start.chain.kappa[4] = bad;
    start.expect_nothing();
    Stretched stiffness(target);
    stiffness.ribbon.bending_stiffness = bad;
    stiffness.expect_nothing();
  }
  Stretched rulings(target);
  rulings.chain.eta[4] = 40;  // |x| > 1
  rulings.expect_nothing();
}

}  // namespace
}  // namespace wunderlich::testing
