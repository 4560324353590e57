#include "wunderlich/energy/motion.hpp"

namespace wunderlich::energy {

double gravity_value(const geometry::Ribbon& ribbon, const Vec3& gravity, const geometry::State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < state.r.size(); ++i) sum -= ribbon.node_mass[i] * gravity.dot(state.r[i]);
  return sum;
}

void add_gravity_gradient(const geometry::Ribbon& ribbon, const Vec3& gravity, Eigen::VectorXd& gradient) {
  for (int i = 0; i <= ribbon.segments; ++i) {
    gradient.segment<3>(geometry::r_index(i)) -= ribbon.node_mass[static_cast<std::size_t>(i)] * gravity;
  }
}

double kinetic_value(const geometry::Ribbon& ribbon, const geometry::State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < state.r_dot.size(); ++i) sum += ribbon.node_mass[i] * state.r_dot[i].squaredNorm();
  return 0.5 * sum;
}

}  // namespace wunderlich::energy
