// The energy of one link in joint coordinates: derivatives, and the same number as in the paper's coordinates.
#include "wunderlich/energy/joint_energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/random_state.hpp"
#include "support/taylor.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using energy::Elastic;
using LinkEnergy = energy::LinkEnergy<double>;
using LinkEnd = energy::LinkEnd<double>;
using LinkQuadrature = energy::LinkQuadrature<double>;
using energy::Model;
using energy::StrainMeasure;
using geometry::Chain;
using geometry::Ribbon;
using geometry::State;

struct NamedModel {
  std::string name;
  Model model;
};

std::vector<NamedModel> models() {
  std::vector<NamedModel> out;
  for (const auto strain : {StrainMeasure::logarithm, StrainMeasure::printed}) {
    const std::string suffix = strain == StrainMeasure::printed ? ", printed strain" : "";
    out.push_back({"wunderlich" + suffix, {Elastic::wunderlich, 0, strain}});
    out.push_back({"truncated at 5" + suffix, {Elastic::truncated, 5, strain}});
    out.push_back({"sadowsky" + suffix, {Elastic::sadowsky, 0, strain}});
  }
  return out;
}

/// A link with hinges of lengths h_a, h_b and the given quadrature.
struct Link {
  Model model;
  LinkQuadrature rule;
  double h_a, h_b, weight, slope, barrier;

  LinkEnergy at(const VectorXd& u) const {
    const auto end = [&](double h, double kappa, double eta) {
      return LinkEnd{{kappa, eta}, energy::bending(model.strain, h, kappa, eta, geometry::make_fold(h, kappa, eta))};
    };
    const double x = slope * (u[3] - u[1]);
    auto wall = energy::ruling_barrier(x);
    wall = {barrier * wall.value, barrier * wall.first, barrier * wall.second};
    return energy::link_energy(energy::width_factor(model, x), wall, slope, rule, weight, end(h_a, u[0], u[1]),
                               end(h_b, u[2], u[3]));
  }
  VectorXd gradient(const VectorXd& u) const {
    const LinkEnergy e = at(u);
    return Vec4(e.grad_a.kappa, e.grad_a.eta, e.grad_b.kappa, e.grad_b.eta);
  }
  Mat4 hessian(const VectorXd& u) const {
    const LinkEnergy e = at(u);
    const auto &aa = e.hess_aa, &bb = e.hess_bb;
    const auto& ab = e.hess_ab;
    Mat4 h;
    h << aa.kappa_kappa, aa.kappa_eta, ab.kappa_kappa, ab.kappa_eta,  //
        aa.kappa_eta, aa.eta_eta, ab.eta_kappa, ab.eta_eta,           //
        ab.kappa_kappa, ab.eta_kappa, bb.kappa_kappa, bb.kappa_eta,   //
        ab.kappa_eta, ab.eta_eta, bb.kappa_eta, bb.eta_eta;
    return h;
  }
};

TEST(LinkEnergyDerivatives, AreSlopes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& [name, model] : models()) {
    for (const LinkQuadrature& rule : {energy::kPlainQuadrature, energy::kCorrectedQuadrature}) {
      for (int trial = 0; trial < 4; ++trial) {
        SCOPED_TRACE(name + (rule.midpoint > 0 ? ", corrected " : ", plain ") + std::to_string(trial));
        Link link{model, rule, 0.3, 0.5, 0.7, 0.4, trial % 2 == 0 ? 0 : 0.02};
        if (trial == 3) link.h_a = 0;  // a free end
        const double eta = unit(random);
        VectorXd u = Vec4(3 * unit(random), eta, 3 * unit(random), eta + 1.8 * unit(random));
        VectorXd d = Vec4(unit(random), unit(random), unit(random), unit(random));
        if (trial == 2) u[0] = 0;
        if (trial == 3) u[0] = d[0] = 0;  // a coordinate that does not exist
        const Mat4 hessian = link.hessian(u);
        expect_derivative([&](double h) { return VectorXd::Constant(1, link.at(u + h * d).value); },
                          VectorXd::Constant(1, link.gradient(u).dot(d)));
        expect_derivative([&](double h) { return link.gradient(u + h * d); }, hessian * d);
      }
    }
  }
}

/// Sum over the links of a chain, as the solver takes it.
double chain_energy(const Ribbon& ribbon, const Model& model, const Chain& chain) {
  double sum = 0;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const auto end = [&](std::size_t i) {
      const double h = geometry::fold_length(ribbon, i), kappa = chain.kappa[i], eta = chain.eta[i];
      return LinkEnd{{kappa, eta}, energy::bending(model.strain, h, kappa, eta, geometry::make_fold(h, kappa, eta))};
    };
    const double slope = 0.5 * ribbon.width / ribbon.rest_length[s], x = slope * (chain.eta[s + 1] - chain.eta[s]);
    const double weight = 0.5 * ribbon.bending_stiffness * ribbon.width * ribbon.rest_length[s];
    sum += energy::link_energy(energy::width_factor(model, x), {0, 0, 0}, slope, energy::quadrature(ribbon, model, s),
                               weight, end(s), end(s + 1))
               .value;
  }
  return sum;
}

Chain random_chain(const Ribbon& ribbon, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Chain chain = geometry::straight_chain(ribbon, {Vec3(0.1, 0.2, -0.3), math::exp_map(Vec3(0.4, -1, 0.3))});
  for (int i = 0; i <= ribbon.segments; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (kappa_is_free(ribbon, i)) chain.kappa[k] = 0.5 * unit(random) / ribbon.rest_length[0];
    if (eta_is_free(ribbon, i)) chain.eta[k] = unit(random);  // |x| < 0.9 for the sample ribbons
  }
  return chain;
}

TEST(JointEnergy, IsTheElasticEnergyOfTheState) {
  std::mt19937 random(2);
  for (const auto& [ribbon_name, ribbon] : sample_ribbons()) {
    for (const auto& [name, model] : models()) {
      SCOPED_TRACE(ribbon_name + ", " + name);
      Chain chain = random_chain(ribbon, random);
      State state = geometry::state_of(ribbon, chain, 0);
      if (ribbon.is_loop()) {
        // Not closed, but of one mind about the seam: its hinge's strain as the frames have it, eta = tau/kappa. The
        // binormal part that is left over has no energy.
        const auto strain = strains(ribbon, state);
        chain.kappa.back() = strain.kappa.back();
        chain.kappa.front() = strain.kappa.front();
        state.eta.back() = chain.eta.back() = strain.tau.back() / strain.kappa.back();
        state.eta.front() = chain.eta.front() = ribbon.seam_sign() * chain.eta.back();
        // gamma may fold the hinge on: the printed measure needs it to be nothing, the exact width factor |x| < 1.
        if (model.strain == StrainMeasure::printed || model.elastic == Elastic::wunderlich) continue;
      }
      const double value = chain_energy(ribbon, model, chain);
      EXPECT_GT(value, 0);
      EXPECT_NEAR(elastic_value(ribbon, model, state) / value, 1, 1e-13);
    }
  }
}

}  // namespace
}  // namespace wunderlich::testing
