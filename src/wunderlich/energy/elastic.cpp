#include "wunderlich/energy/elastic.hpp"

#include <array>

#include "wunderlich/energy/link_terms.hpp"
#include "wunderlich/energy/width_factor.hpp"

namespace wunderlich::energy {

using geometry::Hinge;
using geometry::HingeHessian;
using geometry::HingeJet;
using geometry::Ribbon;
using geometry::State;
using geometry::Strains;

namespace {

/// The chart's share of that: theta of the two segments at either end's hinge, then eta of both ends. A segment may
/// appear more than once: contributions add up.
constexpr int kLocal = 14;
using Local = std::array<int, kLocal>;

double ruling_ratio(const Ribbon& ribbon, const State& state, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  return 0.5 * ribbon.width * (state.eta[s + 1] - state.eta[s]) / ribbon.rest_length[s];
}

/// Energy of one link. The strains of a loop's node 0 are those of the seam's hinge, seen from the start.
LinkTerms link_terms(const Ribbon& ribbon, const Model& model, const State& state, const Strains& strain, int segment) {
  const auto s = static_cast<std::size_t>(segment);
  Ends ends;
  ends << strain.kappa[s], strain.tau[s], state.eta[s], strain.kappa[s + 1], strain.tau[s + 1], state.eta[s + 1];
  return link_terms(ribbon, model, s, ends);
}

/// The hinge whose strain a node shows, with its derivatives; none (before = after = -1) at a free end.
struct NodeJet {
  Hinge hinge;
  HingeJet jet{Vec3::Zero(), Mat3::Zero(), Mat3::Zero()};
  double sign = 1;  ///< of kappa: -1 at node 0 of a loop whose seam reverses the surface
};

std::vector<NodeJet> node_jets(const Ribbon& ribbon, const State& state, StrainMeasure measure) {
  std::vector<NodeJet> out(static_cast<std::size_t>(ribbon.node_count()));
  for (const Hinge& hinge : geometry::hinges(ribbon)) {
    out[static_cast<std::size_t>(hinge.node)] = {hinge, hinge_jet(ribbon, state, hinge, measure), 1};
  }
  if (ribbon.is_loop()) {
    out.front() = out.back();
    out.front().sign = ribbon.seam_sign();
  }
  return out;
}

/// d(kappa, tau)/d(theta before, theta after).
Eigen::Matrix<double, 2, 6> strain_jacobian(const NodeJet& node) {
  Eigen::Matrix<double, 2, 6> out;
  out << node.sign * node.jet.before.row(1), node.sign * node.jet.after.row(1), node.jet.before.row(2),
      node.jet.after.row(2);
  return out;
}

/// Chart index of each local coordinate, -1 where there is none.
Local local_indices(const NodeJet& a, const NodeJet& b, int segment) {
  Local index;
  std::size_t at = 0;
  for (const int s : {a.hinge.before, a.hinge.after, b.hinge.before, b.hinge.after}) {
    for (int k = 0; k < 3; ++k) index[at++] = s < 0 ? -1 : geometry::theta_index(s) + k;
  }
  index[at++] = geometry::eta_index(segment);
  index[at] = geometry::eta_index(segment + 1);
  return index;
}

/// d(ends)/d(local).
Eigen::Matrix<double, 6, kLocal> ends_jacobian(const NodeJet& a, const NodeJet& b) {
  Eigen::Matrix<double, 6, kLocal> out = Eigen::Matrix<double, 6, kLocal>::Zero();
  out.block<2, 6>(0, 0) = strain_jacobian(a);
  out.block<2, 6>(3, 6) = strain_jacobian(b);
  out(kEtaA, 12) = out(kEtaB, 13) = 1;
  return out;
}

/// Adds the curvature of a hinge's strain, dV/dkappa and dV/dtau of the end in question given.
void add_strain_hessian(const Ribbon& ribbon, const State& state, StrainMeasure measure, const NodeJet& node,
                        const Vec2& slope, Triplets& hessian) {
  const Hinge& hinge = node.hinge;
  if (hinge.before < 0 && hinge.after < 0) return;
  const HingeHessian h = hinge_hessian(ribbon, state, hinge, measure, Vec3(0, node.sign * slope[0], slope[1]));
  const int a = geometry::theta_index(hinge.before), b = geometry::theta_index(hinge.after);
  if (hinge.before >= 0) geometry::add_block(a, a, h.before_before, hessian);
  if (hinge.after >= 0) geometry::add_block(b, b, h.after_after, hessian);
  if (hinge.before < 0 || hinge.after < 0) return;
  geometry::add_block(a, b, h.before_after, hessian);
  geometry::add_block(b, a, h.before_after.transpose(), hessian);
}

}  // namespace

double elastic_value(const Ribbon& ribbon, const Model& model, const State& state) {
  const Strains strain = strains(ribbon, state, model.strain);
  double sum = 0;
  for (int s = 0; s < ribbon.segments; ++s) sum += link_terms(ribbon, model, state, strain, s).value;
  return sum;
}

void add_elastic_gradient(const Ribbon& ribbon, const Model& model, const State& state, Eigen::VectorXd& gradient) {
  const Strains strain = strains(ribbon, state, model.strain);
  const std::vector<NodeJet> nodes = node_jets(ribbon, state, model.strain);
  for (int s = 0; s < ribbon.segments; ++s) {
    const auto k = static_cast<std::size_t>(s);
    const LinkTerms terms = link_terms(ribbon, model, state, strain, s);
    const Eigen::Matrix<double, kLocal, 1> local = ends_jacobian(nodes[k], nodes[k + 1]).transpose() * terms.gradient;
    const Local index = local_indices(nodes[k], nodes[k + 1], s);
    for (std::size_t i = 0; i < kLocal; ++i) {
      if (index[i] >= 0) gradient[index[i]] += local[static_cast<Eigen::Index>(i)];
    }
  }
}

void add_elastic_hessian(const Ribbon& ribbon, const Model& model, const State& state, Triplets& hessian) {
  const Strains strain = strains(ribbon, state, model.strain);
  const std::vector<NodeJet> nodes = node_jets(ribbon, state, model.strain);
  for (int s = 0; s < ribbon.segments; ++s) {
    const auto k = static_cast<std::size_t>(s);
    const NodeJet &a = nodes[k], &b = nodes[k + 1];
    const LinkTerms terms = link_terms(ribbon, model, state, strain, s);
    const auto jacobian = ends_jacobian(a, b);
    const Eigen::Matrix<double, kLocal, kLocal> local = jacobian.transpose() * terms.hessian * jacobian;
    const Local index = local_indices(a, b, s);
    for (std::size_t i = 0; i < kLocal; ++i) {
      for (std::size_t j = 0; j < kLocal; ++j) {
        if (index[i] < 0 || index[j] < 0) continue;
        hessian.emplace_back(index[i], index[j], local(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
    add_strain_hessian(ribbon, state, model.strain, a, terms.gradient.segment<2>(0), hessian);
    add_strain_hessian(ribbon, state, model.strain, b, terms.gradient.segment<2>(3), hessian);
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
