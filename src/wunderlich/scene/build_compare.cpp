#include <cmath>

#include "wunderlich/scene/build.hpp"

namespace wunderlich::scene {

namespace {

CompareOptions::Shell shell_of(const Cell& cell, double time_step) {
  return {static_cast<int>(integer(child(cell, "along"))), static_cast<int>(integer(child(cell, "across"))),
          number_or(child(cell, "time_step"), time_step)};
}

}  // namespace

CompareOptions build_compare(const Cell& root, const geometry::RibbonSpec& ribbon, const SolverOptions& solver) {
  constexpr double kLoadTime = 2, kStepsOfLoad = 2000, kDamping = 20, kSettle = 10, kThin = 0.01;
  const Cell cell = child(root, "compare"), rod = child(cell, "rod"), strip = child(root, "ribbon");
  const bool path = solver.method == Method::equilibrium;
  CompareOptions options;
  const Cell segments = child(rod, "segments");
  options.rod_segments = segments.value != nullptr ? static_cast<int>(integer(segments)) : ribbon.segments;
  if (ribbon.closure == geometry::Closure::loop && options.rod_segments < 3) fail(segments, "a loop needs at least 3");
  options.paper_ratio = text(child(rod, "stiffness")) == "ratio";
  options.thickness = number_or(child(cell, "thickness"), number_or(child(strip, "thickness"), kThin * ribbon.width));
  options.poisson_ratio = number_or(child(cell, "poisson_ratio"), number(child(strip, "poisson_ratio")));
  options.length_tolerance = number(child(cell, "length_tolerance"));
  const Cell metric = child(cell, "metric");
  options.implicit_metric = metric.value != nullptr ? text(metric) == "implicit" : path;
  const double wave = std::sqrt(ribbon.area_density / ribbon.bending_stiffness) * ribbon.length * ribbon.length;
  options.load_time = number_or(child(cell, "load_time"), kLoadTime * wave);
  options.settle_time = number_or(child(cell, "settle_time"), kSettle * options.load_time);
  options.time_step = number_or(child(cell, "time_step"), path ? options.load_time / kStepsOfLoad : solver.time_step);
  const Cell damping = child(cell, "damping"), rates = child(child(root, "solver"), "damping");
  options.damping = number_or(damping, path ? kDamping / options.load_time : number(child(rates, "normal")));
  options.damping_tangent = number_or(damping, path ? options.damping : number(child(rates, "tangent")));
  options.conforming = shell_of(child(cell, "shell_conforming"), options.time_step);
  options.nonconforming = shell_of(child(cell, "shell_nonconforming"), options.time_step);
  return options;
}

}  // namespace wunderlich::scene
