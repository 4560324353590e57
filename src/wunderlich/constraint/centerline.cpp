// Length and parallel: how the centerline follows the segments' tangents.
#include "wunderlich/constraint/internal.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::constraint {

using geometry::add_block;
using geometry::r_index;
using geometry::Ribbon;
using geometry::State;
using geometry::theta_index;

namespace {

Vec3 edge(const State& state, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  return state.r[s + 1] - state.r[s];
}

double rest_length(const Ribbon& ribbon, int segment) { return ribbon.rest_length[static_cast<std::size_t>(segment)]; }
Mat3 axes(const State& state, int segment) { return state.q[static_cast<std::size_t>(segment)].toRotationMatrix(); }

}  // namespace

int rows(const Ribbon& ribbon, const Length&) { return ribbon.segments; }

void residual(const Ribbon& ribbon, const Length&, const State& state, ResidualRef out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const double l = rest_length(ribbon, s);
    out[s] = edge(state, s).squaredNorm() - l * l;
  }
}

void add_jacobian(const Ribbon& ribbon, const Length&, const State& state, int first_row, Triplets& out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const Eigen::RowVector3d slope = 2 * edge(state, s).transpose();
    add_block(first_row + s, r_index(s), -slope, out);
    add_block(first_row + s, r_index(s + 1), slope, out);
  }
}

void add_hessian(const Ribbon& ribbon, const Length&, const State&, MultiplierRef multiplier, Triplets& out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const Mat3 block = 2 * multiplier[s] * Mat3::Identity();
    add_block(r_index(s), r_index(s), block, out);
    add_block(r_index(s + 1), r_index(s + 1), block, out);
    add_block(r_index(s), r_index(s + 1), -block, out);
    add_block(r_index(s + 1), r_index(s), -block, out);
  }
}

int rows(const Ribbon& ribbon, const Parallel&) { return 3 * ribbon.segments; }

void residual(const Ribbon& ribbon, const Parallel&, const State& state, ResidualRef out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    out.segment<3>(3 * s) = edge(state, s) / rest_length(ribbon, s) - axes(state, s).col(2);
  }
}

void add_jacobian(const Ribbon& ribbon, const Parallel&, const State& state, int first_row, Triplets& out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const Mat3 stretch = Mat3::Identity() / rest_length(ribbon, s);
    add_block(first_row + 3 * s, r_index(s), -stretch, out);
    add_block(first_row + 3 * s, r_index(s + 1), stretch, out);
    // d3 turns by theta x e3, in the segment's axes.
    add_block(first_row + 3 * s, theta_index(s), axes(state, s) * math::skew(Vec3::UnitZ()), out);
  }
}

void add_hessian(const Ribbon& ribbon, const Parallel&, const State& state, MultiplierRef multiplier, Triplets& out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const Vec3 pull = axes(state, s).transpose() * multiplier.segment<3>(3 * s);
    const Mat3 outer = 0.5 * pull * Vec3::UnitZ().transpose();
    add_block(theta_index(s), theta_index(s), pull.z() * Mat3::Identity() - outer - outer.transpose(), out);
  }
}

}  // namespace wunderlich::constraint
