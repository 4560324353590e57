#include <algorithm>

#include "wunderlich/base/error.hpp"
#include "wunderlich/energy/motion.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/mover.hpp"
#include "wunderlich/solver/two_stage/two_stage.hpp"

namespace wunderlich::scene {

namespace two_stage = solver::two_stage;

namespace {

constexpr double kManySubsteps = 100;  // in a step, of which a user should know

/// The counters of a run, beside the solver's own state.
struct Counters {
  double taken = 0;
  double substeps = 0;
  double exceeded = 0;   ///< steps beyond the stability bound
  double unsettled = 0;  ///< substeps whose contacts stopped short of the tolerance
  double touching = 0;   ///< points and pairs that push
  double nearest = 1e9;  ///< smallest distance to what is touched [m]
};

template <class Counters, class State, class Visit>
void visit_all(Counters& counters, State& state, const Visit& visit) {
  for (auto* c : {&counters.taken, &counters.substeps, &counters.exceeded, &counters.unsettled, &counters.touching,
                  &counters.nearest}) {
    visit(*c);
  }
  const auto vectors = [&](auto& list) {
    for (auto& v : list) visit(v[0]), visit(v[1]), visit(v[2]);
  };
  const auto frames = [&](auto& list) {
    for (auto& q : list) visit(q.x()), visit(q.y()), visit(q.z()), visit(q.w());
  };
  visit(state.shape.time);
  vectors(state.shape.r);
  vectors(state.shape.r_dot);
  frames(state.shape.q);
  for (auto& eta : state.shape.eta) visit(eta);
  frames(state.shape.end_frame);
  for (auto& spin : state.spin) visit(spin);
  for (auto& multiplier : state.multipliers) visit(multiplier);
}

class TwoStageMover : public Mover {
 public:
  explicit TwoStageMover(const Scene& scene) : scene_(scene), ribbon_(motion_ribbon(scene, 0)) {}

  void start(const std::vector<geometry::State>& shapes) override {
    state_ = two_stage::start(ribbon_, shapes.front());
    shapes_ = {state_.shape};
  }

  Move step(double t0, double t1, int, Recording& recording) override {
    const two_stage::Drive drive = drive_between(scene_, ribbon_, state_.shape, t0, t1);
    const two_stage::StepReport report =
        two_stage::step(ribbon_, drive, scene_.solver.two_stage, t1 - t0, state_, work_);
    recording.add_phase_time("ode", report.ode_seconds);
    recording.add_phase_time("opt", report.opt_seconds);
    if (may_touch()) recording.add_phase_time("contact", report.contact_seconds);
    recording.add_phase_time("other", report.other_seconds);
    stable_step_ = report.stable_step;
    if (!report.accepted) return {false, 0, report.failure};
    state_.shape.time = t1;
    shapes_.front() = state_.shape;
    counters_.taken += 1;
    counters_.substeps += report.substeps;
    counters_.exceeded += report.exceeds_bound ? 1 : 0;
    counters_.unsettled += report.contact_unsettled;
    counters_.touching = report.touching;
    counters_.nearest = std::min(counters_.nearest, report.nearest);
    return {true, report.iterations, ""};
  }

  /// Clamps that let go leave their end without a frame of its own.
  void release() override {
    ribbon_ = motion_ribbon(scene_, state_.shape.time);
    if (!ribbon_.clamped[0]) state_.shape.end_frame[0] = state_.shape.q.front();
    if (!ribbon_.clamped[1]) state_.shape.end_frame[1] = state_.shape.q.back();
    shapes_.front() = state_.shape;
  }

  void follow() override {}  // each step asks the scene

  const geometry::Ribbon& ribbon(std::size_t) const override { return ribbon_; }
  const std::vector<geometry::State>& shapes() const override { return shapes_; }
  double kinetic_energy() const override { return energy::kinetic_value(ribbon_, state_.shape); }

  void add_findings(Summary& summary) const override {
    if (may_touch()) {
      const double nearest = counters_.nearest;
      summary.contact = ContactSummary{static_cast<int>(counters_.touching), std::max(0.0, -nearest), nearest};
    }
    if (counters_.unsettled > 0) {
      summary.warnings.push_back("contacts stopped short of their tolerance in " + text_of(counters_.unsettled) +
                                 " substeps; the penetration is within 1 % of the width");
    }
    if (counters_.exceeded > 0) {
      summary.warnings.push_back("the step of " + text_of(scene_.solver.time_step) +
                                 " s is beyond the stability bound of " + text_of(stable_step_) +
                                 " s: what looks like motion may be instability");
    } else if (counters_.substeps > kManySubsteps * counters_.taken) {
      summary.warnings.push_back("each step was divided into " + text_of(counters_.substeps / counters_.taken) +
                                 " (in the mean): the stability bound is " + text_of(stable_step_) + " s");
    }
  }

  std::vector<double> pack() const override {
    std::vector<double> out;
    visit_all(counters_, state_, [&](double number) { out.push_back(number); });
    return out;
  }

  void unpack(const std::vector<geometry::State>& shapes, const std::vector<double>& numbers) override {
    const geometry::State& shape = shapes.front();
    ribbon_ = motion_ribbon(scene_, shape.time);
    state_ = two_stage::start(ribbon_, shape);
    std::size_t size = 0;
    visit_all(counters_, state_, [&](double) { ++size; });
    if (size != numbers.size()) {
      throw InputError("checkpoint: the stored solver state does not fit the stored scene");
    }
    std::size_t next = 0;
    visit_all(counters_, state_, [&](double& number) { number = numbers[next++]; });
    ribbon_ = motion_ribbon(scene_, state_.shape.time);
    shapes_ = {state_.shape};
  }

 private:
  bool may_touch() const { return !scene_.surroundings.obstacles.empty() || scene_.surroundings.contact.self; }

  const Scene& scene_;
  geometry::Ribbon ribbon_;
  two_stage::State state_;
  std::vector<geometry::State> shapes_;  ///< the one
  two_stage::Workspace work_;
  Counters counters_;
  double stable_step_ = 0;
};

}  // namespace

std::unique_ptr<Mover> two_stage_mover(const Scene& scene) { return std::make_unique<TwoStageMover>(scene); }

}  // namespace wunderlich::scene
