/// Ribbons of every kind in random states that violate every constraint: where derivatives are tested.
#pragma once

#include <Eigen/Core>
#include <random>
#include <string>
#include <vector>

#include "wunderlich/geometry/chart.hpp"

namespace wunderlich::testing {

struct NamedRibbon {
  std::string name;
  geometry::Ribbon ribbon;
};

/// Open (free, clamped at one and both ends), loops with 0, 1, 2 half twists; uniform and not. Units far from 1.
std::vector<NamedRibbon> sample_ribbons();

/// Frames turn by up to about a radian a hinge, |x| stays below 0.8, edges are off in length and direction.
geometry::State random_state(const geometry::Ribbon& ribbon, std::mt19937& random);

/// A direction in the chart that changes every coordinate by about one natural unit.
Eigen::VectorXd random_direction(const geometry::Ribbon& ribbon, std::mt19937& random);

geometry::State moved(const geometry::Ribbon& ribbon, const geometry::State& state, const Eigen::VectorXd& increment);

/// A gradient taken at the state moved by `increment`, in the chart of the state it was moved from.
Eigen::VectorXd in_first_chart(const geometry::Ribbon& ribbon, const Eigen::VectorXd& increment,
                               Eigen::VectorXd gradient);

/// A list of triplets as a matrix.
Eigen::MatrixXd dense(int rows, int columns, const geometry::Triplets& triplets);

}  // namespace wunderlich::testing
