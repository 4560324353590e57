#include "wunderlich/math/lbfgs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wunderlich::math {

namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void add(double scale, const std::vector<double>& a, std::vector<double>& out) {
  for (std::size_t i = 0; i < a.size(); ++i) out[i] += scale * a[i];
}

}  // namespace

void Lbfgs::reset(std::size_t size) {
  const auto count = static_cast<std::size_t>(memory);
  position.resize(count);
  gradient.resize(count);
  for (auto& pair : position) pair.resize(size);
  for (auto& pair : gradient) pair.resize(size);
  inverse_product.resize(count);
  share.resize(count);
  stored = 0;
  newest = -1;
}

void Lbfgs::push(const std::vector<double>& position_change, const std::vector<double>& gradient_change) {
  const double product = dot(position_change, gradient_change);
  const double least = 1e-10 * std::sqrt(dot(position_change, position_change) * dot(gradient_change, gradient_change));
  if (!(product > least)) return;
  newest = (newest + 1) % memory;
  stored = std::min(stored + 1, memory);
  const auto k = static_cast<std::size_t>(newest);
  position[k] = position_change;
  gradient[k] = gradient_change;
  inverse_product[k] = 1 / product;
}

void Lbfgs::direction(const std::vector<double>& gradient_now, double scale, std::vector<double>& out) {
  out = gradient_now;
  const auto pair = [&](int age) { return static_cast<std::size_t>((newest - age + memory) % memory); };
  for (int age = 0; age < stored; ++age) {
    const std::size_t k = pair(age);
    share[k] = inverse_product[k] * dot(position[k], out);
    add(-share[k], gradient[k], out);
  }
  if (stored > 0) scale = 1 / (inverse_product[pair(0)] * dot(gradient[pair(0)], gradient[pair(0)]));
  for (double& value : out) value *= -scale;
  for (int age = stored - 1; age >= 0; --age) {
    const std::size_t k = pair(age);
    add(-share[k] - inverse_product[k] * dot(gradient[k], out), position[k], out);
  }
}

}  // namespace wunderlich::math
