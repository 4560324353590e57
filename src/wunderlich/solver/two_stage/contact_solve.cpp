#include "wunderlich/solver/two_stage/contact_solve.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/solver/two_stage/workspace.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

constexpr double kBoundLimit = 1 - 1e-3;  // of |x| in a contact
constexpr double kBoundWatched = 0.5;     // |x| from which on its bound has a row

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

/// Two directions square to a unit vector.
void tangents(const Vec3& normal, Vec3& a, Vec3& b) {
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  a = normal.cross(Vec3::Unit(least)).normalized();
  b = normal.cross(a);
}

/// A row of the cone problem with the force it has so far.
Row& add_cone(double friction, double force, Workspace& work) {
  const auto at = static_cast<std::size_t>(work.cones.size++);
  if (work.contact_rows.size() <= at) work.contact_rows.resize(at + 1);
  work.cones.friction.push_back(friction);
  work.cones.force.push_back(force);
  return work.contact_rows[at];
}

auto column(const Row& row, std::size_t slot) { return row.slope.col(static_cast<Eigen::Index>(slot)); }

/// Slopes of a row times W^-1 times those of another, over the blocks they share.
double weighted_dot(const Row& a, const Row& b, const Equations& equations) {
  double sum = 0;
  for (std::size_t i = 0; i < Row::kMost && a.block[i] >= 0; ++i) {
    for (std::size_t j = 0; j < Row::kMost && b.block[j] >= 0; ++j) {
      if (a.block[i] != b.block[j]) continue;
      const Vec7& inverse = equations.inverse_metric[static_cast<std::size_t>(a.block[i])];
      sum += column(a, i).cwiseProduct(inverse).dot(column(b, j));
    }
  }
  return sum;
}

/// out = J_e W^-1 j^T of one row j; returns the first place that is not 0.
int couple(const Row& row, const Equations& equations, double* out) {
  int first = equations.normal.size;
  for (std::size_t i = 0; i < Row::kMost && row.block[i] >= 0; ++i) {
    const auto block = static_cast<std::size_t>(row.block[i]);
    const Vec7 weighted = equations.inverse_metric[block].cwiseProduct(column(row, i));
    for (std::size_t t = 0; t < static_cast<std::size_t>(equations.touch_count[block]); ++t) {
      const Touching& touching = equations.touch[block][t];
      out[touching.row] +=
          equations.rows[static_cast<std::size_t>(touching.row)].slope.col(touching.slot).dot(weighted);
      first = std::min(first, touching.row);
    }
  }
  return first;
}

/// x <- D^-1/2 L^-1 x.
void forward(const math::BandedMatrix& factored, int first, double* x) {
  const int stride = factored.bandwidth + 1;
  for (int j = first; j < factored.size; ++j) {
    const double* column = factored.lower.data() + static_cast<std::ptrdiff_t>(j) * stride;
    const int reach = std::min(factored.bandwidth, factored.size - 1 - j);
    for (int p = 1; p <= reach; ++p) x[j + p] -= column[p] * x[j];
    x[j] /= std::sqrt(column[0]);
  }
}

/// x <- L^-T D^-1/2 x.
void backward(const math::BandedMatrix& factored, double* x) {
  const int stride = factored.bandwidth + 1;
  for (int j = factored.size - 1; j >= 0; --j) {
    const double* column = factored.lower.data() + static_cast<std::ptrdiff_t>(j) * stride;
    const int reach = std::min(factored.bandwidth, factored.size - 1 - j);
    double value = x[j] / std::sqrt(column[0]);
    for (int p = 1; p <= reach; ++p) value -= column[p] * x[j + p];
    x[j] = value;
  }
}

/// motion += W^-1 j^T force.
void push_row(const Row& row, double force, const Equations& equations, std::vector<Vec7>& motion) {
  for (std::size_t i = 0; i < Row::kMost && row.block[i] >= 0; ++i) {
    const auto block = static_cast<std::size_t>(row.block[i]);
    motion[block] += force * equations.inverse_metric[block].cwiseProduct(column(row, i));
  }
}

double along(const Row& row, const std::vector<Vec7>& motion) {
  double sum = 0;
  for (std::size_t i = 0; i < Row::kMost && row.block[i] >= 0; ++i) {
    sum += column(row, i).dot(motion[static_cast<std::size_t>(row.block[i])]);
  }
  return sum;
}

/// Multipliers of the equations from work.reduced (D^-1/2 L^-1 of what they must make up), as motion.
void push_equations(Workspace& work) {
  backward(work.equations.normal, work.reduced.data());
  for (std::size_t row = 0; row < work.equations.rows.size(); ++row) {
    push_row(work.equations.rows[row], -work.reduced[row], work.equations, work.motion);
  }
}

/// D^-1/2 L^-1 of the residuals, into work.reduced; no motion yet.
bool reduce_equations(Workspace& work) {
  if (!factor_equations(work)) return false;
  const Equations& equations = work.equations;
  work.reduced.resize(equations.rows.size());
  for (std::size_t row = 0; row < equations.rows.size(); ++row) work.reduced[row] = equations.rows[row].residual;
  forward(equations.normal, 0, work.reduced.data());
  work.motion.assign(equations.inverse_metric.size(), Vec7::Zero());
  return true;
}

/// The Delassus matrix J (W^-1 - W^-1 J_e^T N^-1 J_e W^-1) J^T, and slacks once the equations hold.
void assemble_cones(Workspace& work) {
  const Equations& equations = work.equations;
  ConeProblem& cones = work.cones;
  const auto size = static_cast<std::size_t>(cones.size), rows = equations.rows.size();
  work.coupling.assign(size * rows, 0.0);
  work.coupling_start.resize(size);
  cones.matrix.resize(size * size);
  cones.slack.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    double* z = work.coupling.data() + k * rows;
    const int first = couple(work.contact_rows[k], equations, z);
    forward(equations.normal, first, z);
    work.coupling_start[k] = first;
    const auto count = static_cast<Eigen::Index>(rows);
    cones.slack[k] = work.contact_rows[k].residual - ConstVector(z, count).dot(ConstVector(work.reduced.data(), count));
    for (std::size_t j = 0; j <= k; ++j) {
      const int start = std::max(first, work.coupling_start[j]);
      const auto length = static_cast<Eigen::Index>(rows) - start;
      const double* other = work.coupling.data() + j * rows;
      const double both = ConstVector(z + start, length).dot(ConstVector(other + start, length));
      const double value = weighted_dot(work.contact_rows[k], work.contact_rows[j], equations) - both;
      cones.matrix[k * size + j] = cones.matrix[j * size + k] = value;
    }
  }
}

}  // namespace

void touch_row(const Ribbon& ribbon, const geometry::State& shape, const Touch& touch, const Vec3& direction,
               bool rulings, const Workspace& work, Row& row) {
  row = Row();
  for (const Arm& arm : touch.arms()) {
    const double eta = rulings ? eta_at(shape, arm.place) : arm.eta_start;
    add_point(ribbon, shape, arm.place, eta, arm.weight * direction, rulings, work, row);
  }
}

void assemble_touches(const Ribbon& ribbon, const geometry::State& shape, Workspace& work) {
  work.cones.size = 0;
  work.cones.force.clear();
  work.cones.friction.clear();
  for (Touch& touch : work.touches) {
    refresh_touch(shape, work, touch);
    Row& normal = add_cone(touch.friction, touch.push, work);
    touch_row(ribbon, shape, touch, touch.normal, true, work, normal);
    normal.residual = touch.gap - touch.allowed;
    if (touch.friction == 0) continue;
    Vec3 way = -touch.from;
    for (const Arm& arm : touch.arms()) way += arm.weight * material_place(shape, arm.place, arm.eta_start);
    Vec3 a, b;
    tangents(touch.normal, a, b);
    for (const Vec3& direction : {a, b}) {
      Row& row = add_cone(-1, touch.drag.dot(direction), work);
      touch_row(ribbon, shape, touch, direction, false, work, row);
      row.residual = way.dot(direction);
    }
  }
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const double x = 0.5 * ribbon.width * (shape.eta[s + 1] - shape.eta[s]) / ribbon.rest_length[s];
    if (std::abs(x) < kBoundWatched) continue;
    Row& row = add_cone(0, 0, work);
    bound_row(ribbon, shape, s, kBoundLimit, work, row);
  }
}

bool solve_contact_direct(double tolerance, double enough, int max_sweeps, Workspace& work, StepReport& report) {
  if (!reduce_equations(work)) return false;
  assemble_cones(work);
  work.force_before = work.cones.force;
  const ConeReport solved = solve_cones(tolerance, enough, max_sweeps, work.cones);
  report.contact_sweeps += solved.sweeps;
  report.contact_capped += solved.capped;
  const std::size_t rows = work.equations.rows.size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(work.cones.size); ++k) {
    const double by = work.cones.force[k] - work.force_before[k];
    if (by == 0) continue;
    push_row(work.contact_rows[k], by, work.equations, work.motion);
    const auto count = static_cast<Eigen::Index>(rows);
    Eigen::Map<Eigen::VectorXd>(work.reduced.data(), count) += by * ConstVector(work.coupling.data() + k * rows, count);
  }
  push_equations(work);
  return true;
}

bool solve_equations(Workspace& work) {
  if (!reduce_equations(work)) return false;
  work.cones.force.clear();
  push_equations(work);
  return true;
}

void solve_contact_sweeps(double tolerance, int max_sweeps, Workspace& work, StepReport& report) {
  const Equations& equations = work.equations;
  ConeProblem& cones = work.cones;
  const auto size = static_cast<std::size_t>(cones.size);
  work.motion.assign(equations.inverse_metric.size(), Vec7::Zero());
  work.force_before = cones.force;
  // Diagonals: of the equations, then of what touches.
  work.reduced.resize(equations.rows.size() + size);
  for (std::size_t row = 0; row < work.reduced.size(); ++row) {
    const Row& of = row < equations.rows.size() ? equations.rows[row] : work.contact_rows[row - equations.rows.size()];
    work.reduced[row] = weighted_dot(of, of, equations);
  }
  const double* diagonal = work.reduced.data() + equations.rows.size();
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    ++report.contact_sweeps;
    double worst = 0;
    const auto relax = [&](const Row& row, double stiffness, double by) {
      if (by != 0) push_row(row, by, equations, work.motion);
      worst = std::max(worst, std::abs(by) * stiffness);
    };
    for (std::size_t e = 0; e < equations.rows.size(); ++e) {
      const Row& row = equations.rows[e];
      if (work.reduced[e] > 0) {
        relax(row, work.reduced[e], -(row.residual + along(row, work.motion)) / work.reduced[e]);
      }
    }
    for (std::size_t k = 0; k < size; ++k) {
      if (cones.friction[k] < 0 || !(diagonal[k] > 0)) continue;
      const Row& row = work.contact_rows[k];
      const double wanted = cones.force[k] - (row.residual + along(row, work.motion)) / diagonal[k];
      const double next = std::max(0.0, wanted);
      relax(row, diagonal[k], next - cones.force[k]);
      cones.force[k] = next;
      if (cones.friction[k] == 0) continue;
      const Row &first = work.contact_rows[k + 1], &second = work.contact_rows[k + 2];
      const double stiffness = diagonal[k + 1] + diagonal[k + 2];
      double a = cones.force[k + 1] - (first.residual + along(first, work.motion)) / stiffness;
      double b = cones.force[k + 2] - (second.residual + along(second, work.motion)) / stiffness;
      put_into_disc(cones.friction[k] * next, a, b);
      relax(first, stiffness, a - cones.force[k + 1]);
      relax(second, stiffness, b - cones.force[k + 2]);
      cones.force[k + 1] = a;
      cones.force[k + 2] = b;
    }
    if (worst <= tolerance) return;
  }
  ++report.contact_capped;
}

void keep_forces(double share, Workspace& work) {
  const auto taken = [&](std::size_t k) {
    return work.force_before[k] + share * (work.cones.force[k] - work.force_before[k]);
  };
  std::size_t k = 0;
  for (Touch& touch : work.touches) {
    if (k >= work.cones.force.size()) return;
    touch.push = taken(k++);
    if (touch.friction == 0) continue;
    Vec3 a, b;
    tangents(touch.normal, a, b);
    touch.drag = taken(k) * a + taken(k + 1) * b;
    k += 2;
  }
}

}  // namespace wunderlich::solver::two_stage
