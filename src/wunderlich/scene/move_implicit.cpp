#include <algorithm>
#include <cmath>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/cursor.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/mover.hpp"
#include "wunderlich/solver/implicit/implicit.hpp"

namespace wunderlich::scene {

namespace implicit = solver::implicit;

namespace {

/// The supports that hold at a time, on the strip as they hold it.
solver::PathProblem problem_of(const Scene& scene, double time) {
  solver::PathOptions options;
  options.model = scene.solver.energy;
  constraint::Surroundings surroundings = scene.surroundings;
  auto& supports = surroundings.supports;
  supports.erase(std::remove_if(supports.begin(), supports.end(), [&](const auto& s) { return !holds(s, time); }),
                 supports.end());
  return solver::make_path(motion_ribbon(scene, time), surroundings, options);
}

/// What the summary says of the steps so far; numbers, for the checkpoint.
struct Findings {
  double impulses = 0;   ///< steps that Euler's scheme took
  double touching = 0;   ///< points of the strip that feel a solid
  double nearest = 1e9;  ///< smallest distance to a solid [m]
};

template <class Visit>
void visit_all(Findings& findings, implicit::State& state, const Visit& visit) {
  const auto whole = [&](int& number) {
    double real = number;
    visit(real);
    number = real >= 0 && real < 1e6 && real == std::floor(real) ? static_cast<int>(real) : -1;
  };
  const auto vectors = [&](auto& list) {
    for (auto& v : list) visit(v[0]), visit(v[1]), visit(v[2]);
  };
  visit(findings.impulses), visit(findings.touching), visit(findings.nearest);
  auto& p = state.points;
  for (auto* list : {&p.x, &p.v, &p.a, &p.acceleration, &p.x_before, &p.v_before}) vectors(*list);
  auto& base = state.before.base;
  visit(base.position[0]), visit(base.position[1]), visit(base.position[2]);
  visit(base.frame.x()), visit(base.frame.y()), visit(base.frame.z()), visit(base.frame.w());
  for (auto& kappa : state.before.kappa) visit(kappa);
  for (auto& eta : state.before.eta) visit(eta);
  whole(state.level), whole(state.calm);
  for (double* number : {&state.last_step, &state.elastic, &state.peak, &state.missing}) visit(*number);
  for (int c = 0; c < 3; ++c) visit(state.momentum.linear[c]), visit(state.momentum.angular[c]);
  for (auto& c : state.base_reaction) visit(c);
}

class ImplicitMover : public Mover {
 public:
  explicit ImplicitMover(const Scene& scene) : scene_(scene), problem_(problem_of(scene, 0)) {}

  void start(const geometry::State& shape) override {
    state_ = implicit::start(problem_, scene_.solver.implicit, shape, scene_.initial.spin, work_);
    shape_ = implicit::shape_of(problem_, state_);
  }

  Move step(double, double t1, int halvings, Recording& recording) override {
    const Stopwatch watch;
    const implicit::StepReport report = implicit::step(problem_, scene_.solver.implicit, t1, halvings, state_, work_);
    recording.add_phase_time("minimise", watch.seconds());
    if (report.accepted) {
      findings_.impulses += report.inelastic ? 1 : 0;
      findings_.nearest = std::min(findings_.nearest, report.nearest);
      findings_.touching = report.touching;
      shape_ = implicit::shape_of(problem_, state_);
    }
    return {report.accepted, report.iterations, report.failure};
  }

  void release() override {
    const solver::PathProblem before = std::move(problem_);
    problem_ = problem_of(scene_, state_.path.t);
    implicit::change_supports(before, problem_, state_);
    implicit::find_accelerations(problem_, scene_.solver.implicit, state_, work_);
    shape_ = implicit::shape_of(problem_, state_);
  }

  const geometry::Ribbon& ribbon() const override { return problem_.ribbon; }
  const geometry::State& shape() const override { return shape_; }
  double kinetic_energy() const override {
    return implicit::kinetic_energy(problem_.ribbon, scene_.solver.implicit.kinetic, state_.points,
                                    state_.path.chain.eta);
  }
  void add_findings(Summary& summary) const override {
    if (!problem_.surroundings.obstacles.empty() || problem_.surroundings.contact.self) {
      const double nearest = findings_.nearest;
      summary.contact = ContactSummary{static_cast<int>(findings_.touching), std::max(0.0, -nearest), nearest};
    }
    if (findings_.impulses == 0) return;
    summary.warnings.push_back(
        "impulses were taken up without a rebound, in " + text_of(findings_.impulses) +
        " steps: a support starts at once, or the strip comes taut, folds or hits a solid within a step");
  }

  std::vector<double> pack() const override {
    std::vector<double> out = pack_cursor(state_.path);
    out.insert(out.begin(), {state_.path.t, static_cast<double>(out.size())});
    implicit::State state = state_;
    Findings findings = findings_;
    visit_all(findings, state, [&](double number) { out.push_back(number); });
    return out;
  }

  void unpack(const geometry::State&, const std::vector<double>& numbers) override {
    const auto broken = [] { throw InputError("checkpoint: the stored solver state does not fit the stored scene"); };
    if (numbers.size() < 2 || !(numbers[1] >= 0 && numbers[1] < static_cast<double>(numbers.size() - 1))) broken();
    problem_ = problem_of(scene_, numbers[0]);  // later than the last record, and something may have let go since
    const auto end = numbers.begin() + 2 + static_cast<std::ptrdiff_t>(numbers[1]);
    state_.path = solver::PathState();
    state_.path = unpack_cursor(problem_, {numbers.begin() + 2, end});
    implicit::resize(implicit::point_count(problem_.ribbon, scene_.solver.implicit.kinetic), state_.points);
    state_.before = state_.path.chain;
    std::size_t size = 0;
    visit_all(findings_, state_, [&](double) { ++size; });
    if (static_cast<std::ptrdiff_t>(size) != numbers.end() - end) broken();
    auto next = end;
    visit_all(findings_, state_, [&](double& number) { number = *next++; });
    const bool fits = state_.level >= 0 && state_.level < implicit::kDampingLevels && state_.calm >= 0;
    if (!fits || state_.path.phase != solver::Phase::load) broken();
    shape_ = implicit::shape_of(problem_, state_);
  }

 private:
  const Scene& scene_;
  solver::PathProblem problem_;
  implicit::State state_;
  implicit::Workspace work_;
  geometry::State shape_;
  Findings findings_;
};

}  // namespace

std::unique_ptr<Mover> implicit_mover(const Scene& scene) { return std::make_unique<ImplicitMover>(scene); }

}  // namespace wunderlich::scene
