#include "wunderlich/solver/two_stage/objective.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/energy/torsional_inertia.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/central_rate.hpp"

namespace wunderlich::solver::two_stage {

using energy::Ends;
using geometry::Hinge;
using geometry::Ribbon;

namespace {

constexpr double kLargestTurn = 0.4;  // of a frame in one iteration [rad]

double ruling_ratio(const Ribbon& ribbon, const geometry::State& shape, std::size_t s) {
  return 0.5 * ribbon.width * (shape.eta[s + 1] - shape.eta[s]) / ribbon.rest_length[s];
}

double barrier_scale(const Ribbon& ribbon, const OptOptions& options, std::size_t s) {
  return options.barrier * ribbon.bending_stiffness * ribbon.rest_length[s] / ribbon.width;
}

/// E_para of one segment in theta; r is fixed.   @eq Shen2015:20
void add_parallel(const Ribbon& ribbon, const geometry::State& shape, double weight, std::size_t s,
                  energy::TurnTerms& terms) {
  const Vec3 edge = shape.q[s].conjugate() * Vec3((shape.r[s + 1] - shape.r[s]) / ribbon.rest_length[s]);
  const Vec3 e3 = Vec3::UnitZ();
  const Mat3 outer = edge * e3.transpose();
  terms.gradient -= 2 * weight * e3.cross(edge);
  terms.hessian += weight * (2 * edge.z() * Mat3::Identity() - outer - outer.transpose());
}

/// Are these the hinges of the ribbon, or a workspace's from another one.
bool belong_to(const Ribbon& ribbon, const std::vector<Hinge>& hinges) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < ribbon.hinge_length.size(); ++i) {
    if (ribbon.hinge_length[i] == 0) continue;
    if (at == hinges.size() || hinges[at].node != static_cast<int>(i)) return false;
    if (hinges[at++].length != ribbon.hinge_length[i]) return false;
  }
  if (at != hinges.size()) return false;
  return hinges.empty() || !ribbon.is_loop() || (hinges.back().flip == ribbon.seam_sign() && hinges.back().after == 0);
}

}  // namespace

void set_up_views(const Ribbon& ribbon, Workspace& work) {
  if (!belong_to(ribbon, work.hinges)) work.hinges = geometry::hinges(ribbon);
  const auto nodes = static_cast<std::size_t>(ribbon.node_count());
  work.views.assign(nodes, {});
  for (std::size_t i = 0; i < nodes; ++i) work.views[i].eta = static_cast<int>(i);
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    work.views[static_cast<std::size_t>(work.hinges[h].node)].hinge = static_cast<int>(h);
  }
  if (ribbon.is_loop()) {
    work.views.front().hinge = work.views.back().hinge;
    work.views.front().sign = ribbon.seam_sign();
    work.views.back().eta = 0;
    work.views.back().eta_sign = ribbon.seam_sign();
  }
  work.links.resize(nodes - 1);
  work.strain.resize(work.hinges.size());
  work.jet.resize(work.hinges.size());
}

void refresh_strains(const Ribbon& ribbon, const energy::Model& model, const geometry::State& shape, bool jets,
                     Workspace& work) {
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    const Hinge& hinge = work.hinges[h];
    if (jets) {
      work.jet[h] = geometry::hinge_jet(ribbon, shape, hinge, model.strain);
      work.strain[h] = work.jet[h].strain;
    } else {
      const auto [before, after] = geometry::hinge_frames(ribbon, shape, hinge.node);
      work.strain[h] = geometry::hinge_strain(before, after, hinge.length, model.strain);
    }
  }
}

Ends link_ends(const geometry::State& shape, const Workspace& work, std::size_t segment) {
  Ends ends = Ends::Zero();
  for (std::size_t side : {0u, 1u}) {
    const NodeView& view = work.views[segment + side];
    const auto at = static_cast<Eigen::Index>(3 * side);
    if (view.hinge >= 0) {
      const Vec3& strain = work.strain[static_cast<std::size_t>(view.hinge)];
      ends[at] = view.sign * strain[1];
      ends[at + 1] = strain[2];
    }
    ends[at + 2] = shape.eta[segment + side];
  }
  return ends;
}

energy::TurnTerms frame_terms(const Ribbon& ribbon, const geometry::State& shape, const Workspace& work,
                              std::size_t segment) {
  energy::TurnTerms terms{Vec3::Zero(), Mat3::Zero()};
  if (work.inertia[segment] > 0) {
    terms = energy::torsional_inertia(work.inertia[segment], work.carried[segment], shape.q[segment]);
  }
  add_parallel(ribbon, shape, work.parallel_weight, segment, terms);
  terms.gradient -= shape.q[segment].conjugate() * work.torque[segment];
  return terms;
}

double frame_value(const Ribbon& ribbon, const geometry::State& shape, const Workspace& work, std::size_t segment) {
  const Vec3 edge = (shape.r[segment + 1] - shape.r[segment]) / ribbon.rest_length[segment];
  double sum = work.parallel_weight * (edge - shape.q[segment] * Vec3::UnitZ()).squaredNorm();
  if (work.inertia[segment] > 0) {
    const double turn = energy::turn_between(work.carried[segment], shape.q[segment]);
    sum += work.inertia[segment] * turn * turn;
  }
  if (!work.torque[segment].isZero(0)) {
    const Quat& from = work.torque_frame[segment];
    sum -= work.torque[segment].dot(from * math::log_map(from.conjugate() * shape.q[segment]));
  }
  return sum;
}

double proximal_stiffness(const Ribbon& ribbon, const OptOptions& options, std::size_t block) {
  const double length = ribbon.rest_length[std::min(block, ribbon.rest_length.size() - 1)];
  return options.proximal * ribbon.bending_stiffness * length / ribbon.width;
}

double objective_value(const Ribbon& ribbon, const Options& options, const geometry::State& shape,
                       const Workspace& work) {
  double sum = options.opt.central_rate ? central_elastic(ribbon, options.model, shape, work, nullptr) : 0;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    if (!options.opt.central_rate) {
      sum += energy::link_value(ribbon, options.model, s, link_ends(shape, work, s));
    }
    if (options.opt.barrier > 0) {
      sum += barrier_scale(ribbon, options.opt, s) * energy::ruling_barrier(ruling_ratio(ribbon, shape, s)).value;
    }
    sum += frame_value(ribbon, shape, work, s);
  }
  for (std::size_t b = 0; b < static_cast<std::size_t>(block_count(ribbon)); ++b) {
    const double away = shape.eta[b] - work.before.eta[b];
    sum += 0.5 * proximal_stiffness(ribbon, options.opt, b) * away * away;
  }
  return sum;
}

void objective_gradient(const Ribbon& ribbon, const Options& options, const geometry::State& shape, Workspace& work) {
  work.gradient.assign(static_cast<std::size_t>(4 * block_count(ribbon)), 0.0);
  if (options.opt.central_rate) central_elastic(ribbon, options.model, shape, work, &work.gradient);
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    Ends slope = Ends::Zero();
    if (!options.opt.central_rate) {
      work.links[s] = energy::link_terms(ribbon, options.model, s, link_ends(shape, work, s));
      slope = work.links[s].gradient;
    }
    if (options.opt.barrier > 0) {
      const double rate = barrier_scale(ribbon, options.opt, s) * 0.5 * ribbon.width / ribbon.rest_length[s] *
                          energy::ruling_barrier(ruling_ratio(ribbon, shape, s)).first;
      slope[energy::kEtaA] -= rate;
      slope[energy::kEtaB] += rate;
    }
    add_end_slope(work, s, Vec3(slope[0], slope[1], slope[2]), work.gradient);
    add_end_slope(work, s + 1, Vec3(slope[3], slope[4], slope[5]), work.gradient);
    const Vec3 turn = frame_terms(ribbon, shape, work, s).gradient;
    for (std::size_t k = 0; k < 3; ++k) work.gradient[4 * s + 1 + k] += turn[static_cast<Eigen::Index>(k)];
  }
  for (std::size_t b = 0; b < static_cast<std::size_t>(block_count(ribbon)); ++b) {
    work.gradient[4 * b] += proximal_stiffness(ribbon, options.opt, b) * (shape.eta[b] - work.before.eta[b]);
  }
  clear_held(ribbon, work, work.gradient);
}

void add_end_slope(const Workspace& work, std::size_t node, const Vec3& slope, std::vector<double>& out) {
  const NodeView& view = work.views[node];
  out[static_cast<std::size_t>(4 * view.eta)] += view.eta_sign * slope[2];
  if (view.hinge < 0) return;
  const auto h = static_cast<std::size_t>(view.hinge);
  const Vec3 weight(0, view.sign * slope[0], slope[1]);
  const Hinge& hinge = work.hinges[h];
  const Vec3 before = work.jet[h].before.transpose() * weight, after = work.jet[h].after.transpose() * weight;
  for (int k = 0; k < 3; ++k) {
    if (hinge.before >= 0) out[static_cast<std::size_t>(4 * hinge.before + 1 + k)] += before[k];
    if (hinge.after >= 0) out[static_cast<std::size_t>(4 * hinge.after + 1 + k)] += after[k];
  }
}

void clear_held(const Ribbon& ribbon, const Workspace& work, std::vector<double>& out) {
  for (std::size_t b = 0; b < static_cast<std::size_t>(block_count(ribbon)); ++b) {
    if (work.holding.eta_held[b]) out[4 * b] = 0;
    if (b >= work.holding.frame_held.size() || work.holding.frame_held[b]) {
      for (std::size_t k = 1; k < 4; ++k) out[4 * b + k] = 0;
    }
  }
}

double constraint_residual(const Ribbon& ribbon, const geometry::State& shape, Workspace& work) {
  work.residual.assign(static_cast<std::size_t>(2 * block_count(ribbon)), 0.0);
  double worst = 0;
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    const Hinge& hinge = work.hinges[h];
    const auto row = static_cast<std::size_t>(2 * hinge_block(ribbon, hinge));
    const Vec3& strain = work.strain[h];
    const double eta = shape.eta[static_cast<std::size_t>(hinge.node)];
    work.residual[row] = hinge.length * strain[0];
    work.residual[row + 1] = hinge.length * (strain[1] * eta - strain[2]);
    for (std::size_t k = 0; k < 2; ++k) {
      const double size = std::abs(work.residual[row + k]);
      if (!(size <= worst)) worst = size;  // keeps a NaN
    }
  }
  return worst;
}

double largest_ruling_ratio(const Ribbon& ribbon, const geometry::State& shape) {
  double worst = 0;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    worst = std::max(worst, std::abs(ruling_ratio(ribbon, shape, s)));
  }
  return worst;
}

double longest_step(const Ribbon& ribbon, const geometry::State& shape, const Workspace& work) {
  double share = 1;
  const auto eta_step = [&](std::size_t node) {
    const NodeView& view = work.views[node];
    return view.eta_sign * work.step[static_cast<std::size_t>(4 * view.eta)];
  };
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Vec3 theta(work.step[4 * s + 1], work.step[4 * s + 2], work.step[4 * s + 3]);
    if (theta.norm() * share > kLargestTurn) share = kLargestTurn / theta.norm();
    const double slope = 0.5 * ribbon.width / ribbon.rest_length[s];
    const double x = slope * (shape.eta[s + 1] - shape.eta[s]), dx = slope * (eta_step(s + 1) - eta_step(s));
    const double room = kToBoundary * (dx > 0 ? 1 - x : 1 + x);
    if (std::abs(dx) * share > room) share = room / std::abs(dx);
  }
  return share;
}

double largest_share(const std::vector<double>& step) {
  double share = HUGE_VAL;
  for (std::size_t b = 0; 4 * b < step.size(); ++b) {
    share = std::min(share, kLargestTurn / Vec3(step[4 * b + 1], step[4 * b + 2], step[4 * b + 3]).norm());
  }
  return share;
}

void move_unknowns(const Ribbon& ribbon, const std::vector<double>& increment, double scale, const Workspace& work,
                   geometry::State& shape) {
  for (std::size_t b = 0; b < static_cast<std::size_t>(block_count(ribbon)); ++b) {
    shape.eta[b] = work.eta_start[b] + scale * increment[4 * b];
    if (b >= shape.q.size() || work.holding.frame_held[b]) continue;
    const Vec3 theta = scale * Vec3(increment[4 * b + 1], increment[4 * b + 2], increment[4 * b + 3]);
    shape.q[b] = (work.q_start[b] * math::exp_map(theta)).normalized();
  }
  if (ribbon.is_loop()) shape.eta.back() = ribbon.seam_sign() * shape.eta.front();
  follow_ends(ribbon, shape);
}

void follow_ends(const Ribbon& ribbon, geometry::State& shape) {
  if (!ribbon.clamped[0]) shape.end_frame[0] = shape.q.front();
  if (!ribbon.clamped[1]) shape.end_frame[1] = shape.q.back();
}

}  // namespace wunderlich::solver::two_stage
