/// A strip that leans on itself, for tests of its contact with itself.
#pragma once

#include <random>
#include <vector>

#include "solver/paths.hpp"
#include "wunderlich/solver/self_contact.hpp"

namespace wunderlich::testing {

/// Two turns and a half of a coil whose turns lean on each other.
struct Coil {
  geometry::Ribbon ribbon;
  geometry::Chain chain;
  solver::ChainProblem problem;
  Coil() {
    geometry::RibbonSpec spec;
    spec.length = 4;
    spec.width = 0.3;
    spec.segments = 18;
    spec.free_rulings = true;
    ribbon = geometry::make_ribbon(spec);
    chain = geometry::straight_chain(ribbon, {Vec3(0.1, 0.2, 0.3), straight_frame()});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i <= ribbon.segments; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (geometry::kappa_is_free(ribbon, i)) chain.kappa[k] = 2 * kPi / 1.6 * (1 + 0.01 * normal(random));
      chain.eta[k] = 0.25 + 0.005 * normal(random);
    }
    problem.barrier = 0.01;
    problem.base_fixed.fill(true);
    for (int i = 0; i <= ribbon.segments; ++i) {
      problem.force.push_back(Vec3(normal(random), normal(random), normal(random)));
      problem.anchor.push_back(Vec3(normal(random), normal(random), normal(random)));
      problem.tie.push_back(2);
    }
    constraint::Surroundings surroundings;
    surroundings.contact = {0.25, 0.01, true};
    place_self(ribbon, surroundings, 0.25, true, chain.eta, problem.self);
  }
};

inline geometry::Chain moved(const geometry::Chain& chain, const Eigen::VectorXd& x) {
  geometry::Chain out = chain;
  for (std::size_t i = 0; i < out.kappa.size(); ++i) {
    out.kappa[i] += x[2 * static_cast<Eigen::Index>(i)];
    out.eta[i] += x[2 * static_cast<Eigen::Index>(i) + 1];
  }
  return out;
}

inline std::vector<solver::StripPlace> alone(const geometry::Ribbon& ribbon, const geometry::Chain& chain,
                                             const geometry::Kinematics& k) {
  return {{ribbon, chain, k}};
}

}  // namespace wunderlich::testing
