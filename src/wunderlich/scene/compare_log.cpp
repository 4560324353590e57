#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wunderlich/scene/compare_models.hpp"

namespace wunderlich::scene {

long steps_of(double time, double time_step) { return std::lround(std::ceil(time / time_step - 1e-9)); }

ModelLog::ModelLog(const Scene& scene, Model model, double until, double unit, const Observer& observer)
    : scene_(scene), observer_(observer), until_(until), unit_(unit) {
  result_.model = model_name(model);
}

bool ModelLog::count_step(double time, double seconds, int iterations) {
  step_us_.push_back(1e6 * seconds);
  result_.wall_seconds += seconds;
  ++result_.steps;
  iterations_ += iterations;
  const bool goes_on = observer_({"", std::min(1.0, time / until_), static_cast<int>(iterations_)});
  if (!goes_on) result_.failure = kInterrupted;
  return goes_on;
}

Tried ModelLog::in_halves(const Stepped& model, double t0, double t1, int halvings) {
  const Tried tried = model.step_to(t1);
  if (tried.failure.empty() || halvings == kMaxHalvings) return tried;
  const double middle = 0.5 * (t0 + t1);
  const Tried first = in_halves(model, t0, middle, halvings + 1);
  const int before = tried.iterations + first.iterations;
  if (!first.failure.empty()) return {before, first.failure};
  const Tried second = in_halves(model, middle, t1, halvings + 1);
  return {before + second.iterations, second.failure};
}

bool ModelLog::approach(const Stepped& model, double until, long steps) {
  for (long k = 1; k <= steps; ++k) {
    const double part = until / static_cast<double>(steps);
    const Stopwatch watch;
    const Tried tried = in_halves(model, part * static_cast<double>(k - 1), part * static_cast<double>(k), 0);
    if (!tried.failure.empty()) result_.failure = tried.failure + " (on its way to the start)";
    if (!tried.failure.empty() || !count_step(0, watch.seconds(), tried.iterations)) return false;
  }
  return true;
}

bool ModelLog::run(const Stepped& model, double time_step) {
  const long steps = steps_of(until_, time_step);
  for (long k = 1; k <= steps; ++k) {
    const double t0 = static_cast<double>(k - 1) * time_step;
    const double t1 = k == steps ? until_ : static_cast<double>(k) * time_step;
    const Stopwatch watch;
    const Tried tried = in_halves(model, t0, t1, 0);
    if (!tried.failure.empty()) result_.failure = fmt::format("{} (at {:.3g} s)", tried.failure, t1);
    if (!tried.failure.empty() || !count_step(t1, watch.seconds(), tried.iterations)) return false;
    const bool over = model.is_over() || k == steps;
    if (over || wants_frame(t1)) frame(t1, model.surface());
    if (over) break;
  }
  return true;
}

void ModelLog::phase(const std::string& name, double seconds) {
  for (auto& [known, sum] : result_.phases_us) {
    if (known == name) {
      sum += 1e6 * seconds;
      return;
    }
  }
  result_.phases_us.emplace_back(name, 1e6 * seconds);
}

bool ModelLog::wants_frame(double time) {
  if (time < next_frame_) return false;
  next_frame_ += until_ / std::max(1, scene_.output.frames - 1);
  return true;
}

void ModelLog::frame(double time, Mesh surface) { result_.frames.push_back({time / unit_, {}, std::move(surface)}); }

ModelResult ModelLog::finished() {
  const geometry::RibbonSpec& strip = scene_.ribbon;
  const double force = strip.bending_stiffness / strip.width;
  result_.energy.normalized = result_.energy.elastic * strip.length / (strip.bending_stiffness * strip.width);
  if (result_.imbalance) *result_.imbalance /= force;
  if (!step_us_.empty()) {
    const auto middle = step_us_.begin() + static_cast<std::ptrdiff_t>(step_us_.size() / 2);
    std::nth_element(step_us_.begin(), middle, step_us_.end());
    result_.step_us = *middle;
    result_.iterations = static_cast<double>(iterations_) / static_cast<double>(step_us_.size());
    for (auto& [name, sum] : result_.phases_us) sum /= static_cast<double>(step_us_.size());
  }
  return std::move(result_);
}

}  // namespace wunderlich::scene
