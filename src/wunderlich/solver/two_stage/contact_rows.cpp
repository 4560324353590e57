#include "wunderlich/solver/two_stage/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/energy/torsional_inertia.hpp"
#include "wunderlich/math/rotation.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

constexpr int kKinds = 3;  // of equations a block: length, binormal, torsion match

std::size_t block_of(const Ribbon& ribbon, std::size_t node) {
  return ribbon.is_loop() && node == static_cast<std::size_t>(ribbon.segments) ? 0 : node;
}

int row_at(const Ribbon& ribbon, std::size_t block) {
  const int b = static_cast<int>(block);
  return kKinds * (ribbon.is_loop() ? math::folded_place(b, ribbon.segments) : b);
}

/// Column of a row that belongs to a block; opened where the row has none yet.
Eigen::Ref<Vec7> slope_at(std::size_t block, Row& row) {
  const int b = static_cast<int>(block);
  for (std::size_t slot = 0; slot < row.block.size(); ++slot) {
    if (row.block[slot] < 0) row.block[slot] = b;
    if (row.block[slot] == b) return row.slope.col(static_cast<Eigen::Index>(slot));
  }
  return row.slope.col(0);  // not reached: no row touches more nodes
}

/// Adds what a row gains from the turn of a segment's frame [per rad, own axes]: its own, and that with its edge.
void add_turn(const Ribbon& ribbon, const Vec3& slope, std::size_t segment, const Workspace& work, Row& row) {
  const Vec3 with_edge = work.equations.follow[segment].transpose() * slope;
  slope_at(block_of(ribbon, segment), row).head<3>() -= with_edge;
  slope_at(block_of(ribbon, segment + 1), row).head<3>() += with_edge;
  slope_at(block_of(ribbon, segment), row).segment<3>(kThetaPlace) += slope;
}

void add_eta(double slope, std::size_t node, const Workspace& work, Row& row) {
  const NodeView& view = work.views[node];
  slope_at(static_cast<std::size_t>(view.eta), row)[kEtaPlace] += view.eta_sign * slope;
}

void length_row(const Ribbon& ribbon, const geometry::State& shape, std::size_t s, Row& row) {
  const Vec3 edge = shape.r[s + 1] - shape.r[s];
  const double length = edge.norm(), rest = ribbon.rest_length[s];
  const Vec3 slope = edge / (length * rest);
  slope_at(block_of(ribbon, s), row).head<3>() -= slope;
  slope_at(block_of(ribbon, s + 1), row).head<3>() += slope;
  row.residual = length / rest - 1;
}

void hinge_rows(const Ribbon& ribbon, const geometry::State& shape, std::size_t h, const Workspace& work, Row& binormal,
                Row& match) {
  const geometry::Hinge& hinge = work.hinges[h];
  const double eta = shape.eta[static_cast<std::size_t>(hinge.node)], length = hinge.length;
  for (const int segment : {hinge.before, hinge.after}) {
    if (segment < 0) continue;
    const Mat3& jet = segment == hinge.before ? work.jet[h].before : work.jet[h].after;
    const auto s = static_cast<std::size_t>(segment);
    add_turn(ribbon, length * jet.row(0).transpose(), s, work, binormal);
    add_turn(ribbon, length * (eta * jet.row(1) - jet.row(2)).transpose(), s, work, match);
  }
  add_eta(length * work.strain[h][1], static_cast<std::size_t>(hinge.node), work, match);
  binormal.residual = length * work.strain[h][0];
  match.residual = length * (work.strain[h][1] * eta - work.strain[h][2]);
}

void worsen(double value, double& worst) {
  if (!(std::abs(value) <= worst)) worst = std::abs(value);  // keeps a NaN
}

void list_touching(Equations& equations) {
  std::fill(equations.touch_count.begin(), equations.touch_count.end(), 0);
  for (std::size_t row = 0; row < equations.rows.size(); ++row) {
    for (std::size_t slot = 0; slot < Row::kMost && equations.rows[row].block[slot] >= 0; ++slot) {
      const auto b = static_cast<std::size_t>(equations.rows[row].block[slot]);
      const auto at = static_cast<std::size_t>(equations.touch_count[b]++);
      equations.touch[b][at] = {static_cast<int>(row), static_cast<int>(slot)};
    }
  }
}

}  // namespace

double eta_at(const geometry::State& shape, const Place& place) {
  return (1 - place.share) * shape.eta[place.segment] + place.share * shape.eta[place.segment + 1];
}

Vec3 material_place(const geometry::State& shape, const Place& place, double eta) {
  const std::size_t s = place.segment;
  return (1 - place.share) * shape.r[s] + place.share * shape.r[s + 1] + shape.q[s] * Vec3(0, place.v, place.v * eta);
}

Vec3 place_of(const geometry::State& shape, const Place& place) {
  return material_place(shape, place, eta_at(shape, place));
}

void set_metric(const Ribbon& ribbon, const Options& options, double dt, Workspace& work) {
  Equations& equations = work.equations;
  const auto blocks = static_cast<std::size_t>(block_count(ribbon));
  equations.inverse_metric.assign(blocks, Vec7::Zero());
  const bool printed = options.contact.metric == ContactMetric::printed;
  const double stiffness = ribbon.bending_stiffness / ribbon.width;
  for (std::size_t b = 0; b < blocks; ++b) {
    Vec7& inverse = equations.inverse_metric[b];
    inverse.head<3>() = dt * dt * work.holding.inverse_mass[b];
    if (!work.holding.eta_held[b]) {
      const std::size_t s = std::min(b, ribbon.rest_length.size() - 1);
      const double inertia = energy::turn_inertia(ribbon, s) / (dt * dt);
      inverse[kEtaPlace] = printed ? 1 : 1 / (inertia + stiffness * ribbon.rest_length[s]);
    }
    if (b >= ribbon.rest_length.size() || work.holding.frame_held[b]) continue;
    // |dq|^2 is a quarter of |theta|^2. Else: the stiffness that E_para holds tangents with, and the inertia of the
    // turn.
    const double across = printed ? 4 : 0.5 / work.parallel_weight;
    const double about = printed ? 4 : dt * dt / energy::turn_inertia(ribbon, b);
    inverse.segment<3>(kThetaPlace) = Vec3(across, across, about);
  }
}

bool assemble_equations(const Ribbon& ribbon, const Options& options, const geometry::State& shape, Workspace& work) {
  Equations& equations = work.equations;
  const std::size_t segments = ribbon.rest_length.size();
  const auto blocks = static_cast<std::size_t>(block_count(ribbon));
  equations.follow.resize(segments);
  equations.touch.resize(blocks);
  equations.touch_count.resize(blocks);
  equations.rows.assign(kKinds * blocks, Row());
  equations.worst_length = equations.worst_angle = 0;
  refresh_strains(ribbon, options.model, shape, true, work);
  for (std::size_t s = 0; s < segments; ++s) {
    const Vec3 edge = shape.r[s + 1] - shape.r[s];
    equations.follow[s].setZero();
    if (!work.holding.frame_held[s]) {
      equations.follow[s] = shape.q[s].toRotationMatrix().transpose() * math::skew(edge) / edge.squaredNorm();
    }
    Row& row = equations.rows[static_cast<std::size_t>(row_at(ribbon, s))];
    length_row(ribbon, shape, s, row);
    worsen(row.residual, equations.worst_length);
  }
  for (std::size_t h = 0; h < work.hinges.size(); ++h) {
    const auto at =
        static_cast<std::size_t>(row_at(ribbon, static_cast<std::size_t>(hinge_block(ribbon, work.hinges[h]))));
    hinge_rows(ribbon, shape, h, work, equations.rows[at + 1], equations.rows[at + 2]);
    worsen(equations.rows[at + 1].residual, equations.worst_angle);
    worsen(equations.rows[at + 2].residual, equations.worst_angle);
  }
  list_touching(equations);
  return std::isfinite(equations.worst_length) && std::isfinite(equations.worst_angle);
}

bool factor_equations(Workspace& work) {
  Equations& equations = work.equations;
  const int size = static_cast<int>(equations.rows.size());
  int reach = 0;
  for (std::size_t b = 0; b < equations.touch.size(); ++b) {
    int first = size, last = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(equations.touch_count[b]); ++i) {
      first = std::min(first, equations.touch[b][i].row);
      last = std::max(last, equations.touch[b][i].row);
    }
    reach = std::max(reach, last - first);
  }
  equations.normal.reset(size, reach);
  for (std::size_t b = 0; b < equations.touch.size(); ++b) {
    const auto count = static_cast<std::size_t>(equations.touch_count[b]);
    for (std::size_t i = 0; i < count; ++i) {
      const Touching& a = equations.touch[b][i];
      const Vec7 weighted =
          equations.inverse_metric[b].cwiseProduct(equations.rows[static_cast<std::size_t>(a.row)].slope.col(a.slot));
      for (std::size_t j = 0; j <= i; ++j) {
        const Touching& c = equations.touch[b][j];
        equations.normal.at(a.row, c.row) +=
            weighted.dot(equations.rows[static_cast<std::size_t>(c.row)].slope.col(c.slot));
      }
    }
  }
  for (int row = 0; row < size; ++row) {
    double& diagonal = equations.normal.at(row, row);
    diagonal = diagonal > 0 ? diagonal * (1 + 1e-12) : 1;  // rows that depend on each other stay solvable
  }
  return math::factor(equations.normal).sound;
}

void add_point(const Ribbon& ribbon, const geometry::State& shape, const Place& place, double eta,
               const Vec3& direction, bool rulings, const Workspace& work, Row& row) {
  const std::size_t s = place.segment;
  const Vec3 own = shape.q[s].conjugate() * direction;
  slope_at(block_of(ribbon, s), row).head<3>() += (1 - place.share) * direction;
  slope_at(block_of(ribbon, s + 1), row).head<3>() += place.share * direction;
  add_turn(ribbon, Vec3(0, place.v, place.v * eta).cross(own), s, work, row);
  if (!rulings) return;
  add_eta((1 - place.share) * place.v * own.z(), s, work, row);
  add_eta(place.share * place.v * own.z(), s + 1, work, row);
}

void bound_row(const Ribbon& ribbon, const geometry::State& shape, std::size_t segment, double limit,
               const Workspace& work, Row& row) {
  row = Row();
  const double slope = 0.5 * ribbon.width / ribbon.rest_length[segment];
  const double x = slope * (shape.eta[segment + 1] - shape.eta[segment]), sign = std::copysign(1.0, x);
  add_eta(sign * slope, segment, work, row);
  add_eta(-sign * slope, segment + 1, work, row);
  row.residual = limit - std::abs(x);
}

void move_all(const Ribbon& ribbon, const std::vector<Vec7>& motion, double share, Workspace& work,
              geometry::State& shape) {
  work.edge_start.resize(ribbon.rest_length.size());
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s)
    work.edge_start[s] = (shape.r[s + 1] - shape.r[s]).normalized();
  for (std::size_t b = 0; b < motion.size(); ++b) {
    shape.r[b] += share * motion[b].head<3>();
    shape.eta[b] += share * motion[b][kEtaPlace];
  }
  if (ribbon.is_loop()) {
    shape.r.back() = shape.r.front();
    shape.eta.back() = ribbon.seam_sign() * shape.eta.front();
  }
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    if (work.holding.frame_held[s]) continue;
    const Quat turn = math::shortest_rotation(work.edge_start[s], (shape.r[s + 1] - shape.r[s]).normalized());
    const Vec3 theta = share * motion[s].segment<3>(kThetaPlace);
    shape.q[s] = (turn * shape.q[s] * math::exp_map(theta)).normalized();
  }
  follow_ends(ribbon, shape);
}

}  // namespace wunderlich::solver::two_stage
