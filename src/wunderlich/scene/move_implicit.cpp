#include <algorithm>
#include <cmath>
#include <utility>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/cursor.hpp"
#include "wunderlich/scene/drive.hpp"
#include "wunderlich/scene/mover.hpp"
#include "wunderlich/solver/implicit/implicit.hpp"

namespace wunderlich::scene {

namespace implicit = solver::implicit;

namespace {

/// What surrounds a strip, with the supports that hold at a time.
constraint::Surroundings surroundings_at(const Scene& scene, double time) {
  constraint::Surroundings surroundings = scene.surroundings;
  auto& supports = surroundings.supports;
  supports.erase(std::remove_if(supports.begin(), supports.end(), [&](const auto& s) { return !holds(s, time); }),
                 supports.end());
  return surroundings;
}

/// One strip as it is held at a time.
solver::PathProblem path_of(const Scene& scene, double time) {
  solver::PathOptions options;
  options.model = scene.solver.energy;
  return solver::make_path(motion_ribbon(scene, time), surroundings_at(scene, time), options);
}

std::vector<solver::PathProblem> paths_of(const Scene& scene, double time) {
  std::vector<solver::PathProblem> paths;
  for (const Scene* strip : strips_of(scene)) paths.push_back(path_of(*strip, time));
  return paths;
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
  whole(state.level), whole(state.calm);
  for (double* number : {&state.last_step, &state.elastic, &state.peak, &state.missing}) visit(*number);
  for (implicit::StripState& strip : state.strips) {
    auto& p = strip.points;
    for (auto* list : {&p.x, &p.v, &p.a, &p.acceleration, &p.x_before, &p.v_before}) vectors(*list);
    auto& base = strip.before.base;
    visit(base.position[0]), visit(base.position[1]), visit(base.position[2]);
    visit(base.frame.x()), visit(base.frame.y()), visit(base.frame.z()), visit(base.frame.w());
    for (auto& kappa : strip.before.kappa) visit(kappa);
    for (auto& eta : strip.before.eta) visit(eta);
    for (int c = 0; c < 3; ++c) visit(strip.momentum.linear[c]), visit(strip.momentum.angular[c]);
    for (auto& c : strip.base_reaction) visit(c);
  }
}

class ImplicitMover : public Mover {
 public:
  explicit ImplicitMover(const Scene& scene) : scene_(scene), paths_(paths_of(scene, 0)) {}

  void start(const std::vector<geometry::State>& shapes) override {
    std::vector<Vec3> spins;
    for (const Scene* strip : strips_of(scene_)) spins.push_back(strip->initial.spin);
    state_ = implicit::start(paths_, scene_.solver.implicit, shapes, spins, work_);
    take_shapes();
  }

  Move step(double, double t1, int halvings, Recording& recording) override {
    const Stopwatch watch;
    const implicit::StepReport report = implicit::step(paths_, scene_.solver.implicit, t1, halvings, state_, work_);
    recording.add_phase_time("minimise", watch.seconds());
    if (report.accepted) {
      findings_.impulses += report.inelastic ? 1 : 0;
      findings_.nearest = std::min(findings_.nearest, report.nearest);
      findings_.touching = report.touching;
      take_shapes();
    }
    return {report.accepted, report.iterations, report.failure};
  }

  void release() override {
    const std::vector<solver::PathProblem> before = std::exchange(paths_, paths_of(scene_, state_.time()));
    for (std::size_t i = 0; i < paths_.size(); ++i) implicit::change_supports(before[i], paths_[i], state_.strips[i]);
    implicit::find_accelerations(paths_, scene_.solver.implicit, state_, work_);
    take_shapes();
  }

  void follow() override {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      paths_[i].surroundings = surroundings_at(*strips_of(scene_)[i], state_.time());
    }
  }

  const geometry::Ribbon& ribbon(std::size_t strip) const override { return paths_[strip].ribbon; }
  const std::vector<geometry::State>& shapes() const override { return shapes_; }
  double kinetic_energy() const override {
    double sum = 0;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const implicit::StripState& strip = state_.strips[i];
      sum += implicit::kinetic_energy(paths_[i].ribbon, scene_.solver.implicit.kinetic, strip.points,
                                      strip.path.chain.eta);
    }
    return sum;
  }
  void add_findings(Summary& summary) const override {
    if (!scene_.surroundings.obstacles.empty() || scene_.surroundings.contact.self) {
      const double nearest = findings_.nearest;
      summary.contact = ContactSummary{static_cast<int>(findings_.touching), std::max(0.0, -nearest), nearest};
    }
    if (findings_.impulses == 0) return;
    summary.warnings.push_back(
        "impulses were taken up without a rebound, in " + text_of(findings_.impulses) +
        " steps: a support starts at once, or the strip comes taut, folds or hits a solid within a step");
  }

  /// The time, then each strip's cursor behind its size, then the rest.
  std::vector<double> pack() const override {
    std::vector<double> out{state_.time()};
    for (const implicit::StripState& strip : state_.strips) {
      const std::vector<double> cursor = pack_cursor(strip.path);
      out.push_back(static_cast<double>(cursor.size()));
      out.insert(out.end(), cursor.begin(), cursor.end());
    }
    implicit::State state = state_;
    Findings findings = findings_;
    visit_all(findings, state, [&](double number) { out.push_back(number); });
    return out;
  }

  void unpack(const std::vector<geometry::State>&, const std::vector<double>& numbers) override {
    const auto broken = [] { throw InputError("checkpoint: the stored solver state does not fit the stored scene"); };
    if (numbers.empty()) broken();
    paths_ = paths_of(scene_, numbers[0]);  // later than the last record, and something may have let go since
    state_.strips.assign(paths_.size(), {});
    auto next = numbers.begin() + 1;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      implicit::StripState& strip = state_.strips[i];
      const auto left = static_cast<double>(numbers.end() - next);
      if (!(left >= 1 && *next >= 0 && *next < left)) broken();
      const auto size = static_cast<std::ptrdiff_t>(*next++);
      strip.path = unpack_cursor(paths_[i], {next, next + size});
      if (strip.path.phase != solver::Phase::load) broken();
      next += size;
      implicit::resize(implicit::point_count(paths_[i].ribbon, scene_.solver.implicit.kinetic), strip.points);
      strip.before = strip.path.chain;
    }
    std::ptrdiff_t size = 0;
    visit_all(findings_, state_, [&](double) { ++size; });
    if (size != numbers.end() - next) broken();
    visit_all(findings_, state_, [&](double& number) { number = *next++; });
    if (!(state_.level >= 0 && state_.level < implicit::kDampingLevels && state_.calm >= 0)) broken();
    take_shapes();
  }

 private:
  void take_shapes() {
    shapes_.resize(paths_.size());
    for (std::size_t i = 0; i < paths_.size(); ++i) shapes_[i] = implicit::shape_of(paths_[i], state_.strips[i]);
  }

 private:
  const Scene& scene_;
  std::vector<solver::PathProblem> paths_;
  implicit::State state_;
  implicit::Workspace work_;
  std::vector<geometry::State> shapes_;
  Findings findings_;
};

}  // namespace

std::unique_ptr<Mover> implicit_mover(const Scene& scene) { return std::make_unique<ImplicitMover>(scene); }

}  // namespace wunderlich::scene
