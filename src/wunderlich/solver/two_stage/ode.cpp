#include "wunderlich/solver/two_stage/ode.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/energy/parallel_coupling.hpp"

namespace wunderlich::solver::two_stage {

using geometry::Ribbon;

namespace {

/// The last node of a loop is its first.
std::size_t body(const Ribbon& ribbon, std::size_t node) {
  return ribbon.is_loop() && node == static_cast<std::size_t>(ribbon.segments) ? 0 : node;
}

std::size_t body_count(const Ribbon& ribbon) {
  return static_cast<std::size_t>(ribbon.is_loop() ? ribbon.segments : ribbon.node_count());
}

/// F_e - grad_r E_para by node.
void add_up_forces(const Ribbon& ribbon, const Drive& drive, const geometry::State& shape, Workspace& work) {
  work.force.assign(work.views.size(), Vec3::Zero());
  for (std::size_t i = 0; i < body_count(ribbon); ++i) work.force[i] = ribbon.node_mass[i] * drive.gravity;
  for (const Load& load : drive.loads) work.force[body(ribbon, static_cast<std::size_t>(load.node))] += load.force;
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Vec3 pull = energy::parallel_pull(ribbon, work.parallel_weight, shape, static_cast<int>(s));
    work.force[s] += pull;
    work.force[body(ribbon, s + 1)] -= pull;
  }
}

void move_held(std::size_t node, double dt, const Holding& holding, geometry::State& shape) {
  for (int k = 0; k < 3; ++k) {
    if (holding.inverse_mass[node][k] == 0) shape.r_dot[node][k] = (holding.target[node][k] - shape.r[node][k]) / dt;
  }
}

void close_loop(const Ribbon& ribbon, geometry::State& shape) {
  if (!ribbon.is_loop()) return;
  shape.r.back() = shape.r.front();
  shape.r_dot.back() = shape.r_dot.front();
}

Vec3 edge(const geometry::State& shape, std::size_t segment) { return shape.r[segment + 1] - shape.r[segment]; }

/// Row of a segment in the banded matrix: loops are folded, so that the seam stays in the band.
int row_of(const Ribbon& ribbon, std::size_t segment) {
  const int s = static_cast<int>(segment);
  return ribbon.is_loop() ? math::folded_place(s, ribbon.segments) : s;
}

/// J M^-1 J^T and the residual of c = |e| - l, with rows e/|e|. A share of 1e-12 on the diagonal keeps a taut strip
/// between two pins, whose rows depend on each other, solvable.
double assemble_lengths(const Ribbon& ribbon, const geometry::State& shape, Workspace& work) {
  const std::size_t segments = ribbon.rest_length.size();
  work.length.reset(ribbon.segments, ribbon.is_loop() ? 2 : 1);
  work.length_rhs.assign(segments, 0.0);
  const auto& inverse = work.holding.inverse_mass;
  double worst = 0;
  for (std::size_t s = 0; s < segments; ++s) {
    const Vec3 e = edge(shape, s);
    const double length = e.norm(), rest = ribbon.rest_length[s];
    const Vec3 along = e / length;
    const Vec3 both = inverse[s] + inverse[body(ribbon, s + 1)];
    const double diagonal = along.cwiseAbs2().dot(both);
    const int row = row_of(ribbon, s);
    work.length.at(row, row) = diagonal > 0 ? diagonal * (1 + 1e-12) : 1.0;
    work.length_rhs[static_cast<std::size_t>(row)] = length - rest;
    worst = std::max(worst, std::isfinite(length) ? std::abs(length / rest - 1) : HUGE_VAL);
    const std::size_t next = s + 1 < segments ? s + 1 : 0;
    if (next == 0 && !ribbon.is_loop()) continue;
    const Vec3 after = edge(shape, next).normalized();
    work.length.at(row, row_of(ribbon, next)) = -along.cwiseProduct(after).dot(inverse[body(ribbon, s + 1)]);
  }
  return worst;
}

void correct_positions(const Ribbon& ribbon, geometry::State& shape, Workspace& work) {
  work.force.assign(work.views.size(), Vec3::Zero());
  for (std::size_t s = 0; s < ribbon.rest_length.size(); ++s) {
    const Vec3 impulse = work.length_rhs[static_cast<std::size_t>(row_of(ribbon, s))] * edge(shape, s).normalized();
    work.force[s] += impulse;
    work.force[body(ribbon, s + 1)] -= impulse;
  }
  for (std::size_t i = 0; i < body_count(ribbon); ++i) {
    shape.r[i] += work.holding.inverse_mass[i].cwiseProduct(work.force[i]);
  }
  close_loop(ribbon, shape);
}

/// Unit tangent at a node, the chord of its neighbours.
Vec3 node_tangent(const Ribbon& ribbon, const geometry::State& shape, std::size_t node) {
  const std::size_t last = ribbon.rest_length.size();
  Vec3 chord = Vec3::Zero();
  if (node > 0 || ribbon.is_loop()) chord += edge(shape, node > 0 ? node - 1 : last - 1);
  if (node < last) chord += edge(shape, node);
  return chord.stableNormalized();
}

}  // namespace

void damp(const Ribbon& ribbon, const OdeOptions& options, double dt, geometry::State& shape) {
  const bool per_step = options.damping == Damping::per_step;
  const double tangent = per_step ? options.factor_tangent : std::exp(-options.damping_tangent * dt);
  const double normal = per_step ? options.factor_normal : std::exp(-options.damping_normal * dt);
  if (tangent == 1 && normal == 1) return;
  for (std::size_t i = 0; i < body_count(ribbon); ++i) {
    const Vec3 t = node_tangent(ribbon, shape, i);
    const Vec3 along = shape.r_dot[i].dot(t) * t;
    shape.r_dot[i] = tangent * along + normal * (shape.r_dot[i] - along);
  }
}

int project_lengths(const Ribbon& ribbon, const OdeOptions& options, geometry::State& shape, Workspace& work) {
  for (int iteration = 0;; ++iteration) {
    const double worst = assemble_lengths(ribbon, shape, work);
    if (worst <= options.length_tolerance) return iteration;
    if (iteration == options.max_projections || !std::isfinite(worst)) return -1;
    if (!math::factor(work.length).sound) return -1;
    math::solve(work.length, work.length_rhs);
    correct_positions(ribbon, shape, work);
  }
}

bool advance_centerline(const Ribbon& ribbon, const Drive& drive, const OdeOptions& options, double dt,
                        geometry::State& shape, Workspace& work, StepReport& report) {
  work.r_start = shape.r;
  add_up_forces(ribbon, drive, shape, work);
  for (std::size_t i = 0; i < body_count(ribbon); ++i) {
    shape.r_dot[i] += dt * work.holding.inverse_mass[i].cwiseProduct(work.force[i]);
    move_held(i, dt, work.holding, shape);
    shape.r[i] += dt * shape.r_dot[i];
  }
  close_loop(ribbon, shape);
  const int iterations = project_lengths(ribbon, options, shape, work);
  if (iterations < 0) {
    report.failure =
        "stage ode: segment lengths could not be restored; the step is too long, or supports are further "
        "apart than the strip is long";
    return false;
  }
  report.length_iterations += iterations;
  for (std::size_t i = 0; i < body_count(ribbon); ++i) shape.r_dot[i] = (shape.r[i] - work.r_start[i]) / dt;
  damp(ribbon, options, dt, shape);
  close_loop(ribbon, shape);
  return true;
}

}  // namespace wunderlich::solver::two_stage
