#include "baseline/rods.hpp"

#include <cmath>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {

std::vector<Rod> sample_rods() {
  std::vector<Rod> rods;
  const rod::Stiffness stiffness{30, 2.0, 3.0, 1.5};
  for (int half_twists : {-1, 0, 1, 2}) {
    geometry::RibbonSpec spec;
    spec.length = 3;
    spec.width = 0.4;
    spec.segments = 7;
    spec.area_density = 2;
    spec.spacing = {1, 1.3, 0.8, 1, 1.2, 0.9, 1.1};
    if (half_twists >= 0) spec.closure = geometry::Closure::loop;
    spec.half_twists = std::max(0, half_twists);
    rods.push_back(rod::make_rod(spec, stiffness));
    rods.push_back(rods.back());
    rods.back().bending = rod::Bending::separate;
  }
  return rods;
}

std::vector<double> random_increment(const Rod& sample, std::mt19937& random) {
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> out(rod::coordinate_count(sample));
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = (c % 4 == 3 ? 1.0 : 0.2) * normal(random);
  for (std::size_t c = 0; c < 3 && sample.is_loop(); ++c) out[out.size() - 3 + c] = out[c];
  return out;
}

rod::State random_state(const Rod& sample, std::mt19937& random) {
  const rod::State start = sample.is_loop() ? rod::ring_state(sample) : rod::straight_state(sample);
  rod::State state = start;
  rod::move(sample, start, random_increment(sample, random), 0.6, state);
  // Reference directions of no meaning: the same rod with each turned by something.
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t j = 0; j < sample.edges(); ++j) {
    const double turn = normal(random);
    const rod::Section s = rod::section(state, j);
    state.reference[j] = Eigen::AngleAxisd(turn, s.m3) * state.reference[j];
    state.theta[j] -= turn;
    for (std::size_t i = 0; i < sample.nodes(); ++i) {
      if (sample.hinge_length[i] == 0) continue;
      if (rod::joined(sample, i).before == j) state.reference_twist[i] -= turn;
      if (rod::joined(sample, i).after == j) state.reference_twist[i] += turn;
    }
  }
  return state;
}

Quat straight_frame() {
  Mat3 frame;
  frame << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  return Quat(frame);
}

constraint::Support clamp(int node, const Pose& from, const Vec3& to, double turn) {
  constraint::Support support;
  support.node = node;
  support.motion.keys = {{0, from, 0}, {1, {to, from.frame}, turn}};
  return support;
}

geometry::RibbonSpec problem_t_spec(int nodes) {
  geometry::RibbonSpec spec;
  spec.segments = nodes - 1;
  spec.bending_stiffness = 1e9 * 1e-9 / (12 * (1 - 0.09));
  return spec;
}

constraint::Surroundings problem_t_surroundings(int nodes) {
  constraint::Surroundings surroundings;
  const Quat frame = straight_frame();
  surroundings.supports = {clamp(0, {Vec3::Zero(), frame}, Vec3(0.025, 0, 0), -kPi / 2),
                           clamp(nodes - 1, {Vec3(1, 0, 0), frame}, Vec3(0.975, 0, 0), kPi / 2)};
  return surroundings;
}

PathEnd along_path(const Rod& sample, const constraint::Surroundings& surroundings, rod::State start, int steps,
                   const rod::Options& options) {
  PathEnd end;
  end.state = std::move(start);
  rod::Workspace work;
  for (int k = 1; k <= steps; ++k) {
    end.last = rod::equilibrium(sample, surroundings, static_cast<double>(k) / steps, options, end.state, work);
    end.iterations += end.last.iterations;
    if (!end.last.converged()) return end;
  }
  end.done = true;
  end.energy = rod::elastic_energy(sample, end.state).sum();
  return end;
}

}  // namespace wunderlich::testing
