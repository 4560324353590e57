#include "wunderlich/scene/motion.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "wunderlich/constraint/errors.hpp"
#include "wunderlich/energy/elastic.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/geometry/surface.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/start.hpp"

namespace wunderlich::scene {

using geometry::Ribbon;

namespace {

std::unique_ptr<Mover> mover_of(const Scene& scene) {
  return scene.solver.method == Method::two_stage ? two_stage_mover(scene) : implicit_mover(scene);
}

/// Adds energies, keeps the largest errors.
void add_strip(const Scene& scene, const Ribbon& ribbon, const geometry::State& shape, HistoryRow& row) {
  const double elastic = energy::elastic_value(ribbon, scene.solver.energy, shape);
  row.energy.elastic += elastic;
  row.energy.gravity += energy::gravity_value(ribbon, scene.surroundings.gravity, shape);
  row.energy.normalized += normalized(ribbon, elastic);
  const ConstraintErrors errors = constraint::errors(ribbon, shape);
  ConstraintErrors& most = row.constraints;
  for (double ConstraintErrors::*error :
       {&ConstraintErrors::max_length_error, &ConstraintErrors::max_parallel_error, &ConstraintErrors::max_binormal,
        &ConstraintErrors::max_torsion_mismatch, &ConstraintErrors::max_ruling_ratio}) {
    most.*error = std::max(most.*error, errors.*error);
  }
  row.area_error = std::max(row.area_error, geometry::area_error(ribbon, shape));
}

}  // namespace

Motion::Motion(const Scene& s) : scene(s), mover(mover_of(s)) {}

void Motion::start() {
  std::vector<geometry::State> shapes;
  for (const Scene* strip : strips_of(scene)) {
    const Ribbon& ribbon = mover->ribbon(shapes.size());
    Start start = start_of(*strip, ribbon);
    if (failure.empty()) failure = start.failure;
    shapes.push_back(start.failure.empty() ? std::move(start.shape) : geometry::straight_state(ribbon));
  }
  start(shapes);
}

void Motion::start(const std::vector<geometry::State>& shapes) {
  if (failure.empty() && meet(scene, shapes)) failure = "a strip starts across itself or another strip, or touches it";
  mover->start(shapes);
}

HistoryRow Motion::history(int used, double us) const {
  HistoryRow row;
  row.time = time();
  row.energy.kinetic = mover->kinetic_energy();
  for (std::size_t i = 0; i < mover->shapes().size(); ++i) add_strip(scene, mover->ribbon(i), mover->shapes()[i], row);
  row.iterations = used;
  row.step_us = us;
  return row;
}

bool Motion::advance(double t0, double t1, int halvings, int& used) {
  const Move move = mover->step(t0, t1, halvings, recording);
  used += move.iterations;
  if (move.accepted) {
    ++taken;
    return true;
  }
  failure = move.failure;
  if (halvings == kMaxHalvings) return false;
  const double middle = 0.5 * (t0 + t1);
  return advance(t0, middle, halvings + 1, used) && advance(middle, t1, halvings + 1, used);
}

bool Motion::advance_to(double t1, int& used) {
  while (time() < t1) {
    const double t0 = time();
    double next = t1;
    visit_supports(scene, [&](const constraint::Support& support) {
      if (support.release > t0 * (1 + 1e-9) && support.release < next * (1 - 1e-9)) next = support.release;
    });
    if (!advance(t0, next, 0, used)) return false;
    if (released(t0, next)) mover->release();
  }
  return true;
}

/// Has a support let go?
bool Motion::released(double t0, double t1) const {
  bool any = false;
  visit_supports(scene, [&](const constraint::Support& s) { any = any || (holds(s, t0) && !holds(s, t1)); });
  return any;
}

std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

}  // namespace wunderlich::scene
