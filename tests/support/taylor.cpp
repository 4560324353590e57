#include "support/taylor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wunderlich::testing {

TaylorSlope taylor_slope(const std::function<Eigen::VectorXd(double)>& value, const Eigen::VectorXd& derivative) {
  const Eigen::VectorXd start = value(0);
  TaylorSlope out;
  out.linear = derivative.norm();
  std::vector<double> steps, errors;
  for (double h = 1e-2; h > 1e-7; h *= std::sqrt(0.1)) {
    const double error = (value(h) - start - h * derivative).norm();
    // Rounding of the values and of the step itself; below a hundred times that an error says nothing.
    const double rounding = 1e-14 * (start.norm() + h * out.linear);
    if (error < 100 * rounding) break;
    steps.push_back(std::log10(h));
    errors.push_back(std::log10(error));
  }
  const auto n = static_cast<Eigen::Index>(steps.size());
  if (n < 2) return out;
  const Eigen::Map<const Eigen::ArrayXd> x(steps.data(), n), y(errors.data(), n);
  const Eigen::ArrayXd centred = x - x.mean();
  out.slope = (centred * (y - y.mean())).sum() / centred.square().sum();
  out.decades = steps.front() - steps.back();
  return out;
}

void expect_derivative(const std::function<Eigen::VectorXd(double)>& value, const Eigen::VectorXd& derivative) {
  const TaylorSlope seen = taylor_slope(value, derivative);
  EXPECT_GE(seen.slope, 1.9);
  EXPECT_GE(seen.decades, 2);
  EXPECT_GT(seen.linear, 0);
}

}  // namespace wunderlich::testing
