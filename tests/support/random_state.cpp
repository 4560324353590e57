#include "support/random_state.hpp"

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {

using geometry::Ribbon;
using geometry::RibbonSpec;
using geometry::State;

namespace {

Vec3 random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

}  // namespace

std::vector<NamedRibbon> sample_ribbons() {
  RibbonSpec spec;
  spec.length = 0.7;
  spec.width = 0.09;
  spec.segments = 6;
  spec.bending_stiffness = 3e-2;
  spec.area_density = 0.4;
  std::vector<NamedRibbon> out{{"free", make_ribbon(spec)}};
  spec.clamped = {true, false};
  out.push_back({"clamped at the start", make_ribbon(spec)});
  spec.clamped = {true, true};
  spec.spacing = {1, 2, 1.5, 0.7, 1, 3};
  out.push_back({"clamped at both ends, not uniform", make_ribbon(spec)});
  spec.clamped = {false, false};
  spec.closure = geometry::Closure::loop;
  for (int half_twists : {0, 1, 2, -3}) {
    spec.half_twists = half_twists;
    out.push_back({"loop with " + std::to_string(half_twists) + " half twists", make_ribbon(spec)});
  }
  return out;
}

State random_state(const Ribbon& ribbon, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  State state = straight_state(ribbon);
  const double segment = ribbon.length / ribbon.segments;
  Quat frame = math::exp_map(random_vector(random));
  if (ribbon.clamped[0]) state.end_frame[0] = frame;
  for (std::size_t s = 0; s < state.q.size(); ++s) {
    frame = frame * math::exp_map(0.4 * random_vector(random));
    state.q[s] = frame;
    state.r[s + 1] =
        state.r[s] + frame * Vec3(ribbon.rest_length[s] * Vec3(0, 0, 1)) + 0.2 * segment * random_vector(random);
    state.eta[s + 1] = state.eta[s] + 0.8 * unit(random) * 2 * ribbon.rest_length[s] / ribbon.width;
    state.r_dot[s] = random_vector(random);
  }
  if (ribbon.clamped[1]) state.end_frame[1] = frame * math::exp_map(0.3 * random_vector(random));
  state.eta[0] += 0.1;
  return state;
}

Eigen::VectorXd random_direction(const Ribbon& ribbon, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd out(geometry::chart_size(ribbon));
  for (int i = 0; i <= ribbon.segments; ++i) {
    out.segment<3>(geometry::r_index(i)) = ribbon.length / ribbon.segments * random_vector(random);
    out[geometry::eta_index(i)] = normal(random);
    if (i < ribbon.segments) out.segment<3>(geometry::theta_index(i)) = random_vector(random);
  }
  return out;
}

State moved(const Ribbon& ribbon, const State& state, const Eigen::VectorXd& increment) {
  State out = state;
  geometry::move(ribbon, increment, out);
  return out;
}

Eigen::VectorXd in_first_chart(const Ribbon& ribbon, const Eigen::VectorXd& increment, Eigen::VectorXd gradient) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const int k = geometry::theta_index(s);
    gradient.segment<3>(k) =
        (math::right_jacobian(increment.segment<3>(k)).transpose() * gradient.segment<3>(k)).eval();
  }
  return gradient;
}

Eigen::MatrixXd dense(int rows, int columns, const geometry::Triplets& triplets) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
  for (const auto& entry : triplets) out(entry.row(), entry.col()) += entry.value();
  return out;
}

}  // namespace wunderlich::testing
