/// Finite-difference tests of derivatives: the error of a Taylor expansion must fall as the square of the step.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace wunderlich::testing {

/// What a slope test saw; a derivative is right if `slope >= 1.9` over `decades >= 2` and `linear` is not 0.
struct TaylorSlope {
  double slope = 0;    ///< least-squares slope of log error against log step, errors above rounding only
  double decades = 0;  ///< of step that the fit spans
  double linear = 0;   ///< size of the first-order term relative to the step
};

/// `value(h)` along a line, `derivative` its claimed derivative at 0. Scalars are vectors of one component.
TaylorSlope taylor_slope(const std::function<Eigen::VectorXd(double)>& value, const Eigen::VectorXd& derivative);

/// Expects a quadratic error and a derivative that is not 0; says what was seen otherwise.
void expect_derivative(const std::function<Eigen::VectorXd(double)>& value, const Eigen::VectorXd& derivative);

}  // namespace wunderlich::testing
