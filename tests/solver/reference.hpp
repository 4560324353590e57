/// The independent solutions of validation/reference, and profiles to hold against them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace wunderlich::testing {

nlohmann::json reference(const std::string& file);

/// kappa and tau along a closed strip of length 2 pi with its inflection at u = 0.
struct Profile {
  std::vector<double> u, kappa, tau;
};

/// moebius_5pi.csv.
Profile reference_profile();

/// Value at u by the cubic through the four nearest samples of an increasing grid.
double interpolate(const std::vector<double>& grid, const std::vector<double>& values, double u);

}  // namespace wunderlich::testing
