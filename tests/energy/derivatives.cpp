// Gradients and Hessians of every energy, at random states off the constraint set.
#include <gtest/gtest.h>

#include "support/random_state.hpp"
#include "support/taylor.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/energy/parallel_coupling.hpp"

namespace wunderlich::testing {
namespace {

using Eigen::VectorXd;
using energy::Elastic;
using energy::Model;
using energy::StrainMeasure;
using geometry::Ribbon;
using geometry::State;

struct Energy {
  std::string name;
  std::function<double(const Ribbon&, const State&)> value;
  std::function<void(const Ribbon&, const State&, VectorXd&)> add_gradient;
  std::function<void(const Ribbon&, const State&, geometry::Triplets&)> add_hessian;
};

Energy elastic(const std::string& name, const Model& model) {
  return {name, [model](const Ribbon& r, const State& s) { return elastic_value(r, model, s); },
          [model](const Ribbon& r, const State& s, VectorXd& g) { add_elastic_gradient(r, model, s, g); },
          [model](const Ribbon& r, const State& s, geometry::Triplets& h) { add_elastic_hessian(r, model, s, h); }};
}

std::vector<Energy> energies() {
  const auto log = StrainMeasure::logarithm, printed = StrainMeasure::printed;
  return {elastic("wunderlich", {Elastic::wunderlich, 0, log}),
          elastic("wunderlich, printed strain", {Elastic::wunderlich, 0, printed}),
          elastic("truncated at 5", {Elastic::truncated, 5, log}),
          elastic("truncated at 2, printed strain", {Elastic::truncated, 2, printed}),
          elastic("sadowsky", {Elastic::sadowsky, 0, log}),
          elastic("sadowsky, printed strain", {Elastic::sadowsky, 0, printed}),
          {"barrier", [](const Ribbon& r, const State& s) { return energy::barrier_value(r, 0.3, s); },
           [](const Ribbon& r, const State& s, VectorXd& g) { energy::add_barrier_gradient(r, 0.3, s, g); },
           [](const Ribbon& r, const State& s, geometry::Triplets& h) { energy::add_barrier_hessian(r, 0.3, s, h); }},
          {"parallel", [](const Ribbon& r, const State& s) { return energy::parallel_value(r, 2.5, s); },
           [](const Ribbon& r, const State& s, VectorXd& g) { energy::add_parallel_gradient(r, 2.5, s, g); },
           [](const Ribbon& r, const State& s, geometry::Triplets& h) { energy::add_parallel_hessian(r, 2.5, s, h); }}};
}

VectorXd gradient(const Energy& energy, const Ribbon& ribbon, const State& state) {
  VectorXd g = VectorXd::Zero(geometry::chart_size(ribbon));
  energy.add_gradient(ribbon, state, g);
  return g;
}

VectorXd scalar(double value) { return VectorXd::Constant(1, value); }

TEST(EnergyDerivatives, GradientIsTheSlopeOfTheValue) {
  std::mt19937 random(1);
  for (const auto& [name, ribbon] : sample_ribbons()) {
    for (const Energy& energy : energies()) {
      SCOPED_TRACE(name + ", " + energy.name);
      const State state = random_state(ribbon, random);
      const VectorXd d = random_direction(ribbon, random);
      const auto line = [&, &strip = ribbon](double h) {
        return scalar(energy.value(strip, moved(strip, state, h * d)));
      };
      expect_derivative(line, scalar(gradient(energy, ribbon, state).dot(d)));
    }
  }
}

TEST(EnergyDerivatives, HessianIsTheSlopeOfTheGradient) {
  std::mt19937 random(2);
  for (const auto& [name, ribbon] : sample_ribbons()) {
    for (const Energy& energy : energies()) {
      SCOPED_TRACE(name + ", " + energy.name);
      const int size = geometry::chart_size(ribbon);
      const State state = random_state(ribbon, random);
      const VectorXd d = random_direction(ribbon, random);
      geometry::Triplets triplets;
      energy.add_hessian(ribbon, state, triplets);
      const Eigen::MatrixXd hessian = dense(size, size, triplets);
      EXPECT_LE((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
      // Gradients are in the chart of the state where they are taken: bring them all into one.
      const auto line = [&, &strip = ribbon](double h) {
        return in_first_chart(strip, h * d, gradient(energy, strip, moved(strip, state, h * d)));
      };
      expect_derivative(line, hessian * d);
    }
  }
}

TEST(EnergyDerivatives, GravityIsLinear) {
  std::mt19937 random(3);
  const Vec3 g(0.3, -1.2, -9.81);
  for (const auto& [name, ribbon] : sample_ribbons()) {
    SCOPED_TRACE(name);
    const State state = random_state(ribbon, random);
    const VectorXd d = random_direction(ribbon, random);
    VectorXd slope = VectorXd::Zero(d.size());
    energy::add_gravity_gradient(ribbon, g, slope);
    const double rise =
        energy::gravity_value(ribbon, g, moved(ribbon, state, d)) - energy::gravity_value(ribbon, g, state);
    EXPECT_GT(slope.norm(), 0.01);
    EXPECT_NEAR(rise, slope.dot(d), 1e-13);
  }
}

}  // namespace
}  // namespace wunderlich::testing
