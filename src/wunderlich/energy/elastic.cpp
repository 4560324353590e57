#include "wunderlich/energy/elastic.hpp"

#include <array>

#include "wunderlich/energy/width_factor.hpp"

namespace wunderlich::energy {

using geometry::Hinge;
using geometry::HingeHessian;
using geometry::HingeJet;
using geometry::Ribbon;
using geometry::State;

namespace {

/// Coordinates of one hinge's energy: theta of both segments, eta of the node, and the two eta of each segment that
/// holds half of it. The same eta may appear more than once: contributions add up.
constexpr int kTheta = 0, kEta = 6, kLeft = 7, kRight = 9, kLocal = 11;
using Local = Eigen::Matrix<double, kLocal, 1>;
using LocalMatrix = Eigen::Matrix<double, kLocal, kLocal>;

double ruling_ratio(const Ribbon& ribbon, const State& state, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  return 0.5 * ribbon.width * (state.eta[s + 1] - state.eta[s]) / ribbon.rest_length[s];
}

/// Chart index of each local coordinate, -1 where there is none.
std::array<int, kLocal> local_indices(const Hinge& hinge) {
  std::array<int, kLocal> index;
  for (int k = 0; k < 3; ++k) {
    index[static_cast<std::size_t>(k)] = hinge.before < 0 ? -1 : geometry::theta_index(hinge.before) + k;
    index[static_cast<std::size_t>(k) + 3] = hinge.after < 0 ? -1 : geometry::theta_index(hinge.after) + k;
  }
  index[kEta] = geometry::eta_index(hinge.node);
  index[kLeft] = hinge.before < 0 ? -1 : geometry::eta_index(hinge.before);
  index[kLeft + 1] = hinge.before < 0 ? -1 : geometry::eta_index(hinge.before + 1);
  index[kRight] = hinge.after < 0 ? -1 : geometry::eta_index(hinge.after);
  index[kRight + 1] = hinge.after < 0 ? -1 : geometry::eta_index(hinge.after + 1);
  return index;
}

/// What one segment contributes to the weight of a hinge: D w l/4 phi(x), with derivatives in eta_{s+1}.
WidthFactor half_cell(const Ribbon& ribbon, const Model& model, const State& state, int segment) {
  if (segment < 0) return {0, 0, 0};
  const double length = ribbon.rest_length[static_cast<std::size_t>(segment)];
  const WidthFactor phi = width_factor(model, ruling_ratio(ribbon, state, segment));
  const double scale = 0.25 * ribbon.bending_stiffness * ribbon.width * length;
  const double x_slope = 0.5 * ribbon.width / length;
  return {scale * phi.value, scale * x_slope * phi.first, scale * x_slope * x_slope * phi.second};
}

/// E of one hinge with derivatives in (gamma, kappa, tau, eta).
struct Density {
  double value;
  Vec4 gradient;
  Mat4 hessian;
};

Density density(const Vec3& strain, double eta) {
  const double kappa = strain[1], tau = strain[2];
  Density e{kappa * kappa + tau * tau * (2 + eta * eta), Vec4::Zero(), Mat4::Zero()};
  e.gradient << 0, 2 * kappa, 2 * tau * (2 + eta * eta), 2 * tau * tau * eta;
  e.hessian(1, 1) = 2;
  e.hessian(2, 2) = 2 * (2 + eta * eta);
  e.hessian(2, 3) = e.hessian(3, 2) = 4 * tau * eta;
  e.hessian(3, 3) = 2 * tau * tau;
  return e;
}

double node_eta(const State& state, const Hinge& hinge) { return state.eta[static_cast<std::size_t>(hinge.node)]; }

/// d(strain, eta)/d(local).
Eigen::Matrix<double, 4, kLocal> density_jacobian(const HingeJet& jet) {
  Eigen::Matrix<double, 4, kLocal> jacobian = Eigen::Matrix<double, 4, kLocal>::Zero();
  jacobian.block<3, 3>(0, kTheta) = jet.before;
  jacobian.block<3, 3>(0, kTheta + 3) = jet.after;
  jacobian(3, kEta) = 1;
  return jacobian;
}

/// Gradient of the weight in the local coordinates.
Local weight_gradient(const WidthFactor& left, const WidthFactor& right) {
  Local g = Local::Zero();
  g[kLeft] = -left.first;
  g[kLeft + 1] = left.first;
  g[kRight] = -right.first;
  g[kRight + 1] = right.first;
  return g;
}

void add_weight_hessian(double scale, const WidthFactor& left, const WidthFactor& right, LocalMatrix& h) {
  Mat2 pattern;
  pattern << 1, -1, -1, 1;
  h.block<2, 2>(kLeft, kLeft) += scale * left.second * pattern;
  h.block<2, 2>(kRight, kRight) += scale * right.second * pattern;
}

Local hinge_gradient(const Ribbon& ribbon, const Model& model, const State& state, const Hinge& hinge) {
  const HingeJet jet = hinge_jet(ribbon, state, hinge, model.strain);
  const Density e = density(jet.strain, node_eta(state, hinge));
  const WidthFactor left = half_cell(ribbon, model, state, hinge.before);
  const WidthFactor right = half_cell(ribbon, model, state, hinge.after);
  return (left.value + right.value) * density_jacobian(jet).transpose() * e.gradient +
         e.value * weight_gradient(left, right);
}

LocalMatrix hinge_energy_hessian(const Ribbon& ribbon, const Model& model, const State& state, const Hinge& hinge) {
  const HingeJet jet = hinge_jet(ribbon, state, hinge, model.strain);
  const Density e = density(jet.strain, node_eta(state, hinge));
  const WidthFactor left = half_cell(ribbon, model, state, hinge.before);
  const WidthFactor right = half_cell(ribbon, model, state, hinge.after);
  const double weight = left.value + right.value;
  const auto jacobian = density_jacobian(jet);
  const HingeHessian bend = hinge_hessian(ribbon, state, hinge, model.strain, weight * e.gradient.head<3>());
  const Local e_slope = jacobian.transpose() * e.gradient;
  const Local w_slope = weight_gradient(left, right);
  LocalMatrix h = weight * jacobian.transpose() * e.hessian * jacobian;
  h += e_slope * w_slope.transpose() + w_slope * e_slope.transpose();
  h.block<3, 3>(kTheta, kTheta) += bend.before_before;
  h.block<3, 3>(kTheta, kTheta + 3) += bend.before_after;
  h.block<3, 3>(kTheta + 3, kTheta) += bend.before_after.transpose();
  h.block<3, 3>(kTheta + 3, kTheta + 3) += bend.after_after;
  add_weight_hessian(e.value, left, right, h);
  return h;
}

}  // namespace

double elastic_value(const Ribbon& ribbon, const Model& model, const State& state) {
  double sum = 0;
  for (const Hinge& hinge : geometry::hinges(ribbon)) {
    const auto [before, after] = hinge_frames(ribbon, state, hinge.node);
    const Vec3 strain = geometry::hinge_strain(before, after, hinge.length, model.strain);
    sum += density(strain, node_eta(state, hinge)).value *
           (half_cell(ribbon, model, state, hinge.before).value + half_cell(ribbon, model, state, hinge.after).value);
  }
  return sum;
}

void add_elastic_gradient(const Ribbon& ribbon, const Model& model, const State& state, Eigen::VectorXd& gradient) {
  for (const Hinge& hinge : geometry::hinges(ribbon)) {
    const Local local = hinge_gradient(ribbon, model, state, hinge);
    const auto index = local_indices(hinge);
    for (int k = 0; k < kLocal; ++k) {
      const int row = index[static_cast<std::size_t>(k)];
      if (row >= 0) gradient[row] += local[k];
    }
  }
}

void add_elastic_hessian(const Ribbon& ribbon, const Model& model, const State& state, Triplets& hessian) {
  for (const Hinge& hinge : geometry::hinges(ribbon)) {
    const LocalMatrix local = hinge_energy_hessian(ribbon, model, state, hinge);
    const auto index = local_indices(hinge);
    for (int j = 0; j < kLocal; ++j) {
      for (int k = 0; k < kLocal; ++k) {
        const int row = index[static_cast<std::size_t>(j)], column = index[static_cast<std::size_t>(k)];
        if (row >= 0 && column >= 0) hessian.emplace_back(row, column, local(j, k));
      }
    }
  }
}

double barrier_value(const Ribbon& ribbon, double e1, const State& state) {
  double sum = 0;
  for (int s = 0; s < ribbon.segments; ++s) {
    sum += ribbon.rest_length[static_cast<std::size_t>(s)] * ruling_barrier(ruling_ratio(ribbon, state, s)).value;
  }
  return e1 * ribbon.bending_stiffness / ribbon.width * sum;
}

void add_barrier_gradient(const Ribbon& ribbon, double e1, const State& state, Eigen::VectorXd& gradient) {
  const double scale = 0.5 * e1 * ribbon.bending_stiffness;  // l/w times dx/deta = w/(2l)
  for (int s = 0; s < ribbon.segments; ++s) {
    const double slope = scale * ruling_barrier(ruling_ratio(ribbon, state, s)).first;
    gradient[geometry::eta_index(s)] -= slope;
    gradient[geometry::eta_index(s + 1)] += slope;
  }
}

void add_barrier_hessian(const Ribbon& ribbon, double e1, const State& state, Triplets& hessian) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const double scale =
        0.25 * e1 * ribbon.bending_stiffness * ribbon.width / ribbon.rest_length[static_cast<std::size_t>(s)];
    const double second = scale * ruling_barrier(ruling_ratio(ribbon, state, s)).second;
    const int a = geometry::eta_index(s), b = geometry::eta_index(s + 1);
    hessian.emplace_back(a, a, second);
    hessian.emplace_back(b, b, second);
    hessian.emplace_back(a, b, -second);
    hessian.emplace_back(b, a, -second);
  }
}

}  // namespace wunderlich::energy
