#include "solver/reference.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace wunderlich::testing {

namespace {

std::ifstream open_reference(const std::string& name) {
  std::ifstream file(std::string(WUNDERLICH_SOURCE_DIR) + "/validation/reference/" + name);
  if (!file) throw std::runtime_error("cannot read " + name);
  return file;
}

}  // namespace

nlohmann::json reference(const std::string& name) {
  std::ifstream file = open_reference(name);
  return nlohmann::json::parse(file);
}

Profile reference_profile() {
  std::ifstream file = open_reference("moebius_5pi.csv");
  std::string line;
  std::getline(file, line);
  Profile out;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double u = 0, kappa = 0, tau = 0;
    fields >> u >> kappa >> tau;
    out.u.push_back(u);
    out.kappa.push_back(kappa);
    out.tau.push_back(tau);
  }
  return out;
}

double interpolate(const std::vector<double>& grid, const std::vector<double>& values, double u) {
  const auto above = std::lower_bound(grid.begin(), grid.end(), u) - grid.begin();
  const auto last = static_cast<std::ptrdiff_t>(grid.size()) - 4;
  const auto first = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 2, 0, last));
  double sum = 0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + 4; ++j) {
      if (j != i) weight *= (u - grid[j]) / (grid[i] - grid[j]);
    }
    sum += weight * values[i];
  }
  return sum;
}

}  // namespace wunderlich::testing
