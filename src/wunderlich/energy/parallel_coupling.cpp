#include "wunderlich/energy/parallel_coupling.hpp"

#include <cmath>

#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::energy {

using geometry::Ribbon;
using geometry::State;

namespace {

/// Edge over rest length, in the axes of the segment: e3 where parallel.
Vec3 edge_in_frame(const Ribbon& ribbon, const State& state, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  return state.q[s].conjugate() * Vec3((state.r[s + 1] - state.r[s]) / ribbon.rest_length[s]);
}

}  // namespace

double parallel_value(const Ribbon& ribbon, double parallel_weight, const State& state) {
  double sum = 0;
  for (int s = 0; s < ribbon.segments; ++s) sum += (edge_in_frame(ribbon, state, s) - Vec3::UnitZ()).squaredNorm();
  return parallel_weight * sum;
}

Vec3 parallel_pull(const Ribbon& ribbon, double parallel_weight, const State& state, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  const double length = ribbon.rest_length[s];
  const Vec3 apart = (state.r[s + 1] - state.r[s]) / length - state.q[s] * Vec3::UnitZ();
  return 2 * parallel_weight / length * apart;
}

void add_parallel_gradient(const Ribbon& ribbon, double parallel_weight, const State& state,
                           Eigen::VectorXd& gradient) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const Vec3 edge = edge_in_frame(ribbon, state, s);
    const Vec3 pull = parallel_pull(ribbon, parallel_weight, state, s);
    gradient.segment<3>(geometry::r_index(s)) -= pull;
    gradient.segment<3>(geometry::r_index(s + 1)) += pull;
    // |edge| does not change with theta: the rest is -2 edge . (theta x e3).
    gradient.segment<3>(geometry::theta_index(s)) -= 2 * parallel_weight * Vec3::UnitZ().cross(edge);
  }
}

void add_parallel_hessian(const Ribbon& ribbon, double parallel_weight, const State& state,
                          geometry::Triplets& hessian) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const auto k = static_cast<std::size_t>(s);
    const double length = ribbon.rest_length[k];
    const Vec3 edge = edge_in_frame(ribbon, state, s);
    const Mat3 stretch = 2 * parallel_weight / (length * length) * Mat3::Identity();
    const Mat3 turn = 2 * parallel_weight / length * state.q[k].toRotationMatrix() * math::skew(Vec3::UnitZ());
    const Mat3 outer = edge * Vec3::UnitZ().transpose();
    const Mat3 bend = parallel_weight * (2 * edge.z() * Mat3::Identity() - outer - outer.transpose());
    const int a = geometry::r_index(s), b = geometry::r_index(s + 1), t = geometry::theta_index(s);
    geometry::add_block(a, a, stretch, hessian);
    geometry::add_block(b, b, stretch, hessian);
    geometry::add_block(a, b, -stretch, hessian);
    geometry::add_block(b, a, -stretch, hessian);
    geometry::add_block(a, t, -turn, hessian);
    geometry::add_block(t, a, -turn.transpose(), hessian);
    geometry::add_block(b, t, turn, hessian);
    geometry::add_block(t, b, turn.transpose(), hessian);
    geometry::add_block(t, t, bend, hessian);
  }
}

double parallel_weight(const Ribbon& ribbon, const Model& model, const State& state, double weight_scale) {
  geometry::Triplets hessian;
  add_elastic_hessian(ribbon, model, state, hessian);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(geometry::chart_size(ribbon));
  for (const auto& entry : hessian) {
    if (entry.row() == entry.col()) diagonal[entry.row()] += entry.value();
  }
  double sum = 0;
  for (int i = 0; i <= ribbon.segments; ++i) {
    sum += std::abs(diagonal[geometry::eta_index(i)]);
    if (i < ribbon.segments) sum += 4 * diagonal.segment<3>(geometry::theta_index(i)).lpNorm<1>();
  }
  return weight_scale * sum / (4 * ribbon.segments + ribbon.node_count());
}

}  // namespace wunderlich::energy
