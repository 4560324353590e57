// Binormal, torsion match and ruling bound: what makes the surface developable and free of crossing rulings.
#include "wunderlich/constraint/internal.hpp"

namespace wunderlich::constraint {

using geometry::add_block;
using geometry::eta_index;
using geometry::Hinge;
using geometry::HingeHessian;
using geometry::HingeJet;
using geometry::Ribbon;
using geometry::State;
using geometry::theta_index;

namespace {

int hinge_count(const Ribbon& ribbon) {
  int count = 0;
  for (double length : ribbon.hinge_length) count += length > 0;
  return count;
}

double node_eta(const State& state, const Hinge& hinge) { return state.eta[static_cast<std::size_t>(hinge.node)]; }

/// The row weight . strain.
void add_strain_row(const Hinge& hinge, const HingeJet& jet, const Vec3& weight, int row, Triplets& out) {
  if (hinge.before >= 0) add_block(row, theta_index(hinge.before), weight.transpose() * jet.before, out);
  if (hinge.after >= 0) add_block(row, theta_index(hinge.after), weight.transpose() * jet.after, out);
}

void add_strain_hessian(const Hinge& hinge, const HingeHessian& h, Triplets& out) {
  if (hinge.before >= 0) add_block(theta_index(hinge.before), theta_index(hinge.before), h.before_before, out);
  if (hinge.after >= 0) add_block(theta_index(hinge.after), theta_index(hinge.after), h.after_after, out);
  if (hinge.before < 0 || hinge.after < 0) return;
  add_block(theta_index(hinge.before), theta_index(hinge.after), h.before_after, out);
  add_block(theta_index(hinge.after), theta_index(hinge.before), h.before_after.transpose(), out);
}

/// The entry d2/(deta dtheta) = slope of one frame, in both triangles.
void add_mixed(int eta, int theta, const Eigen::RowVector3d& slope, Triplets& out) {
  add_block(eta, theta, slope, out);
  add_block(theta, eta, slope.transpose(), out);
}

}  // namespace

int rows(const Ribbon& ribbon, const Binormal&) { return hinge_count(ribbon); }

void residual(const Ribbon& ribbon, const Binormal& c, const State& state, ResidualRef out) {
  int row = 0;
  for (const Hinge& hinge : hinges(ribbon)) out[row++] = hinge_jet(ribbon, state, hinge, c.strain).strain[0];
}

void add_jacobian(const Ribbon& ribbon, const Binormal& c, const State& state, int first_row, Triplets& out) {
  for (const Hinge& hinge : hinges(ribbon)) {
    add_strain_row(hinge, hinge_jet(ribbon, state, hinge, c.strain), Vec3::UnitX(), first_row++, out);
  }
}

void add_hessian(const Ribbon& ribbon, const Binormal& c, const State& state, MultiplierRef multiplier, Triplets& out) {
  int row = 0;
  for (const Hinge& hinge : hinges(ribbon)) {
    const Vec3 weight = multiplier[row++] * Vec3::UnitX();
    add_strain_hessian(hinge, hinge_hessian(ribbon, state, hinge, c.strain, weight), out);
  }
}

int rows(const Ribbon& ribbon, const TorsionMatch&) { return hinge_count(ribbon); }

void residual(const Ribbon& ribbon, const TorsionMatch& c, const State& state, ResidualRef out) {
  int row = 0;
  for (const Hinge& hinge : hinges(ribbon)) {
    const Vec3 strain = hinge_jet(ribbon, state, hinge, c.strain).strain;
    out[row++] = strain[1] * node_eta(state, hinge) - strain[2];
  }
}

void add_jacobian(const Ribbon& ribbon, const TorsionMatch& c, const State& state, int first_row, Triplets& out) {
  for (const Hinge& hinge : hinges(ribbon)) {
    const HingeJet jet = hinge_jet(ribbon, state, hinge, c.strain);
    add_strain_row(hinge, jet, Vec3(0, node_eta(state, hinge), -1), first_row, out);
    out.emplace_back(first_row++, eta_index(hinge.node), jet.strain[1]);
  }
}

void add_hessian(const Ribbon& ribbon, const TorsionMatch& c, const State& state, MultiplierRef multiplier,
                 Triplets& out) {
  int row = 0;
  for (const Hinge& hinge : hinges(ribbon)) {
    const double scale = multiplier[row++];
    const Vec3 weight = scale * Vec3(0, node_eta(state, hinge), -1);
    add_strain_hessian(hinge, hinge_hessian(ribbon, state, hinge, c.strain, weight), out);
    const HingeJet jet = hinge_jet(ribbon, state, hinge, c.strain);
    const int eta = eta_index(hinge.node);
    if (hinge.before >= 0) add_mixed(eta, theta_index(hinge.before), scale * jet.before.row(1), out);
    if (hinge.after >= 0) add_mixed(eta, theta_index(hinge.after), scale * jet.after.row(1), out);
  }
}

int rows(const Ribbon& ribbon, const RulingBound&) { return 2 * ribbon.segments; }

void residual(const Ribbon& ribbon, const RulingBound&, const State& state, ResidualRef out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const auto k = static_cast<std::size_t>(s);
    const double x = 0.5 * ribbon.width * (state.eta[k + 1] - state.eta[k]) / ribbon.rest_length[k];
    out[2 * s] = 1 - x;
    out[2 * s + 1] = 1 + x;
  }
}

void add_jacobian(const Ribbon& ribbon, const RulingBound&, const State&, int first_row, Triplets& out) {
  for (int s = 0; s < ribbon.segments; ++s) {
    const double slope = 0.5 * ribbon.width / ribbon.rest_length[static_cast<std::size_t>(s)];
    for (int side : {0, 1}) {
      const double sign = side == 0 ? 1 : -1;
      out.emplace_back(first_row + 2 * s + side, eta_index(s), sign * slope);
      out.emplace_back(first_row + 2 * s + side, eta_index(s + 1), -sign * slope);
    }
  }
}

void add_hessian(const Ribbon&, const RulingBound&, const State&, MultiplierRef, Triplets&) {}  // linear

}  // namespace wunderlich::constraint
