#include "wunderlich/scene/recording.hpp"

#include <algorithm>
#include <cmath>

#include "wunderlich/geometry/topology.hpp"

namespace wunderlich::scene {

namespace {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// Largest turn of a hinge [rad].
double most_bent(const geometry::Ribbon& ribbon, const std::vector<double>& kappa) {
  double most = 0;
  for (std::size_t i = 0; i < kappa.size(); ++i) most = std::max(most, std::abs(kappa[i]) * ribbon.hinge_length[i]);
  return most;
}

}  // namespace

void Recording::add_phase_time(const std::string& phase, double seconds) {
  for (auto& [name, sum] : timing.phases) {
    if (name == phase) {
      sum += seconds;
      return;
    }
  }
  timing.phases.emplace_back(phase, seconds);
}

Timing Recording::finished(int steps, int iterations) const {
  Timing out = timing;
  out.step_us_median = percentile(step_us, 0.5);
  out.step_us_p95 = percentile(step_us, 0.95);
  out.iterations_mean = steps > 0 ? static_cast<double>(iterations) / steps : 0;
  return out;
}

void thin(std::vector<Record>& records, int limit) {
  const auto most = static_cast<std::size_t>(std::max(2, limit));
  if (records.size() <= most) return;
  std::vector<Record> kept;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i % 2 == 0 || i + 1 == records.size()) kept.push_back(std::move(records[i]));
  }
  records = std::move(kept);
}

double normalized(const geometry::Ribbon& ribbon, double elastic) {
  return elastic * ribbon.length / (ribbon.bending_stiffness * ribbon.width);
}

Summary summary_of(const Scene& scene, const geometry::Ribbon& ribbon, const Record& last, Outcome outcome) {
  const geometry::State& state = last.states.front();
  const std::vector<double> kappa = geometry::strains(ribbon, state).kappa;
  Summary summary;
  summary.scene = scene.name;
  summary.converged = outcome == Outcome::converged;
  summary.segments = ribbon.segments;
  summary.time = state.time;
  summary.energy = last.history.energy;
  summary.constraints = last.history.constraints;
  summary.area_error = last.history.area_error;
  summary.topology = geometry::topology(ribbon, state);
  summary.kappa_zeros = geometry::kappa_zeros(ribbon, kappa);
  if (scene.ribbon.closure == geometry::Closure::loop) {
    summary.closure_error = (state.r.back() - state.r.front()).norm() / ribbon.length;
  }
  if (most_bent(ribbon, kappa) > 0.5) {
    summary.warnings.push_back("some hinges turn by more than 0.5 rad; more segments would resolve the curvature");
  }
  const bool turns = scene.ribbon.closure == geometry::Closure::loop && std::abs(scene.ribbon.half_twists) >= 2;
  if (turns && !scene.surroundings.contact.self) {
    summary.warnings.push_back(
        "the strip does not feel itself: a loop with this many half twists may pass through itself; "
        "`contact.self: true` keeps it from that");
  }
  return summary;
}

}  // namespace wunderlich::scene
