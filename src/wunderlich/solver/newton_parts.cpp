#include "wunderlich/solver/newton_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::solver {

using geometry::Chain;
using geometry::Ribbon;

namespace {

/// How far |x| may move towards 1 in one step, as a share of the way.
constexpr double kBoundaryFraction = 0.9;

}  // namespace

double merit_of(const NewtonWorkspace& work, const ObjectiveValue& value, const std::vector<double>& residuals,
                double emphasis) {
  double merit = value.total();
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    merit += residuals[i] * (work.step.multiplier[i] + 0.5 * emphasis * work.system.rows[i].penalty * residuals[i]);
  }
  return merit;
}

double slope_of(const NewtonWorkspace& work, double emphasis) {
  double slope = work.sweep.base_gradient.dot(work.step.base);
  for (std::size_t i = 0; i < work.step.u.size(); ++i) slope += work.sweep.gradient[i].dot(work.step.u[i]);
  for (std::size_t i = 0; i < work.system.rows.size(); ++i) {
    const auto& row = work.system.rows[i];
    slope -= row.residual * (work.step.multiplier[i] - row.multiplier + emphasis * row.penalty * row.residual);
  }
  return slope;
}

double infeasibility_of(const NewtonWorkspace& work) {
  double sum = 0;
  for (const auto& row : work.system.rows) sum += row.penalty * row.residual * row.residual;
  return sum;
}

double emphasis_of(double infeasibility, double slope) {
  const double excess = slope + 0.5 * infeasibility;
  return infeasibility > 0 && excess > 0 ? 1 + excess / infeasibility : 1;
}

double turn_squared(const NewtonWorkspace& work, std::size_t node) {
  const math::Four turn = math::turn_of(work.system.links[node], work.step.u[node]);
  return math::dot3(turn, turn);
}

double measure_step(const Ribbon& ribbon, const NewtonWorkspace& work, NewtonReport& report) {
  const double shorter = 1 / (ribbon.length * ribbon.length);
  double most = report.last_step * report.last_step, turn = 0;
  for (std::size_t i = 0; i < work.step.u.size(); ++i) {
    const double turned = turn_squared(work, i), moved = work.step.v[i].squaredNorm() * shorter;
    const double slanted = 1e-6 * work.step.u[i][1] * work.step.u[i][1];
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double size = turned + moved + slanted < kInfinity ? std::max({turned, moved, slanted}) : kInfinity;
    turn = std::max(turn, turned);
    if (size <= most) continue;
    most = size;
    report.worst_node = static_cast<int>(i);
  }
  report.last_step = std::sqrt(most);
  return std::sqrt(turn);
}

double step_limit(const Ribbon& ribbon, const NewtonOptions& options, const Chain& chain, const NewtonWorkspace& work,
                  double largest_turn) {
  double limit = 1;
  const auto& step = work.step;
  for (std::size_t s = 0; s + 1 < step.u.size(); ++s) {
    const double k = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = k * (chain.eta[s + 1] - chain.eta[s]);
    const double dx = k * (step.u[s + 1][1] - step.u[s][1]);
    const double room = kBoundaryFraction * (dx > 0 ? 1 - x : 1 + x);
    if (limit * std::abs(dx) > room) limit = room / std::abs(dx);
  }
  const double turn = std::max(step.base.tail<3>().norm(), largest_turn);
  return turn * limit > options.max_turn ? options.max_turn / turn : limit;
}

void apply_step(const Chain& chain, const math::ChainStep& step, double scale, Chain& trial) {
  trial.base.position = chain.base.position + scale * step.base.head<3>();
  trial.base.frame = (math::exp_map(scale * step.base.tail<3>()) * chain.base.frame).normalized();
  trial.kappa.resize(step.u.size());
  trial.eta.resize(step.u.size());
  for (std::size_t i = 0; i < step.u.size(); ++i) {
    trial.kappa[i] = chain.kappa[i] + scale * step.u[i][0];
    trial.eta[i] = chain.eta[i] + scale * step.u[i][1];
  }
}

double max_abs(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) {
    if (std::isnan(v)) return v;
    most = std::max(most, std::abs(v));
  }
  return most;
}

Vec2 shift_units(const Ribbon& ribbon) {
  const double l = ribbon.length / ribbon.segments;
  return ribbon.bending_stiffness * l * Vec2(ribbon.width, 1 / ribbon.width);
}

void set_shift(const Ribbon& ribbon, double shift, math::ChainSystem& system) {
  const Vec2 unit = shift * shift_units(ribbon);
  const double base = shift * ribbon.bending_stiffness * ribbon.width / ribbon.length;
  system.shift = {unit[0], unit[1]};
  system.base_shift = {base / (ribbon.length * ribbon.length), base};
}

}  // namespace wunderlich::solver
