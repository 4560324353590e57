/// Random linearised chains.
#pragma once

#include <Eigen/Core>
#include <array>
#include <random>

#include "wunderlich/math/chain_sweep.hpp"

namespace wunderlich::testing {

constexpr std::array<bool, 6> kHeld{true, true, true, true, true, true};
constexpr std::array<bool, 6> kPinned{true, true, true, false, false, false};
constexpr std::array<bool, 6> kOddlyHeld{false, true, false, false, false, true};
constexpr std::array<bool, 6> kFloating{};

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  double operator()() { return normal(engine); }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
  Vec2 pair() { return {(*this)(), (*this)()}; }
  Eigen::MatrixXd symmetric(Eigen::Index size, double shift) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return (*this)(); });
    return half * half.transpose() - shift * Eigen::MatrixXd::Identity(size, size);
  }
};

/// `softness`: 0 makes every term of the Hessian positive, more makes negative modes likely.
math::ChainSystem random_system(int links, const std::array<bool, 6>& base_fixed, double softness, Random& random);

/// Rows with a penalty see a pose only; the others see everything.
void add_random_rows(int count, Random& random, math::ChainSystem& system);

}  // namespace wunderlich::testing
