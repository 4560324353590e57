// Where the models of a comparison start.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "wunderlich/scene/compare.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {
namespace {

Scene scene_of(const char* text) { return read_scene_text(text, "start.yaml", {}); }

/// Largest distance of the surface's rims' four corners at the first frame from those of the ribbon.
double corners_apart(const Scene& scene, Model model) {
  const Observer go_on = [](const RunStatus&) { return true; };
  const Mesh ribbon = run_model(scene, Model::ribbon, go_on).frames.front().surface;
  const ModelResult other = run_model(scene, model, go_on);
  const auto& points = other.frames.front().surface.points;
  double apart = 0;
  for (const Vec3& corner : {points.front(), points.back()}) {
    double nearest = 1e9;
    for (const Vec3& at : ribbon.points) nearest = std::min(nearest, (at - corner).norm());
    apart = std::max(apart, nearest);
  }
  return apart;
}

const char* const kCoil = R"(
ribbon: {length: 1, width: 0.1, segments: 40, bending_stiffness: 1e-6, area_density: 1}
initial: {shape: coil, radius: 0.2, slope: 0.3, position: [1, 2, 3], tangent: [0, 0, 1], normal: [1, 0, 0], spin: [0, 0, 2]}
solver: {duration: 0.002, time_step: 0.001}
compare: {shell_conforming: {along: 41, across: 4}, shell_nonconforming: {along: 41, across: 4}}
)";

TEST(CompareStart, ShellsStartOnTheRibbonsCoil) {
  const Scene scene = scene_of(kCoil);
  EXPECT_LT(corners_apart(scene, Model::shell_conforming), 1e-9);
  EXPECT_LT(corners_apart(scene, Model::shell_nonconforming), 5e-3);  // drawn from midpoints
}

// A clamp at the end alone, away from where the flat strip has it: the energy is that of a beam, q^2 w l^5/(40 D).
TEST(CompareStart, AClampAtTheEndAlonePlacesAShell) {
  const Scene scene = scene_of(R"(
ribbon: {length: 1, width: 0.1, segments: 20, bending_stiffness: 1, area_density: 1}
clamps: [{at: end, position: [1, 1, 1]}]
gravity: [0, 0, -0.1]
solver: {method: equilibrium}
compare: {time_step: 0.02, shell_conforming: {along: 11, across: 3}}
)");
  const ModelResult shell = run_model(scene, Model::shell_conforming, [](const RunStatus&) { return true; });
  EXPECT_TRUE(shell.converged) << shell.failure;
  EXPECT_NEAR(shell.energy.elastic / 2.5e-5, 1, 0.02);
  EXPECT_LT(shell.length_error, 1e-6);
}

std::pair<ModelResult, ModelResult> ribbon_and_shell(const Scene& scene) {
  const Observer go_on = [](const RunStatus&) { return true; };
  ModelResult shell = run_model(scene, Model::shell_conforming, go_on);
  EXPECT_TRUE(shell.converged) << shell.failure;
  return {run_model(scene, Model::ribbon, go_on), std::move(shell)};
}

// The end of the flat strip is led to where its clamp is; where it jumped there, the shell came to rest with 9 % more
// energy than the ribbon.
TEST(CompareStart, AShellIsBroughtToAClampNearerThanItsLength) {
  const Scene scene = scene_of(R"(
ribbon: {length: 1, width: 0.1, segments: 20, bending_stiffness: 1, area_density: 1}
clamps: [{at: start}, {at: end, position: [0.6, 0, 0]}]
solver: {method: equilibrium}
compare: {shell_conforming: {along: 21, across: 3}}
)");
  const auto [ribbon, shell] = ribbon_and_shell(scene);
  EXPECT_NEAR(shell.energy.elastic / ribbon.energy.elastic, 1, 0.03);
  ASSERT_TRUE(shell.imbalance && ribbon.imbalance);
  EXPECT_LE(*shell.imbalance, 1e-6);
  EXPECT_LE(*ribbon.imbalance, 1e-8);
}

// A path ends at its duration, whatever the keyframes after it say; the shell then rests under the loads of that time.
TEST(CompareStart, AShellRestsUnderTheLoadsOfThePathsEnd) {
  const Scene scene = scene_of(R"(
ribbon: {length: 1, width: 0.1, segments: 20, bending_stiffness: 1, area_density: 1}
clamps: [{at: start}]
forces: [{at: end, keyframes: [{time: 0, force: [0, 0, 0]}, {time: 1, force: [0, 0, 0.1]}, {time: 2, force: [0, 0, 1]}]}]
solver: {method: equilibrium, duration: 1}
compare: {shell_conforming: {along: 21, across: 3}}
)");
  const auto [ribbon, shell] = ribbon_and_shell(scene);
  EXPECT_NEAR(shell.energy.elastic / ribbon.energy.elastic, 1, 0.08);
}

// A free strip that spins about its tangent and nothing else: w^3 rho l/12 is its moment of inertia.
TEST(CompareStart, TheRodSpinsAboutItsTangent) {
  const Scene scene = scene_of(R"(
ribbon: {length: 1, width: 0.1, segments: 10, bending_stiffness: 1, area_density: 6}
initial: {spin: [3, 0, 0]}
solver: {method: implicit, duration: 0.01, time_step: 0.001}
compare: {time_step: 0.001}
)");
  const ModelResult rod = run_model(scene, Model::rod, [](const RunStatus&) { return true; });
  EXPECT_TRUE(rod.converged) << rod.failure;
  EXPECT_NEAR(rod.energy.kinetic, 0.5 * 6 * 1e-3 / 12 * 9, 1e-9);
}

// Straight from its clamp the ribbon is out of balance by the moment of its whole weight there, and by nothing without.
TEST(CompareBalance, TheRibbonsIsTheMomentOfItsWeight) {
  const Scene scene = scene_of(R"(
ribbon: {length: 1, width: 0.1, segments: 10, bending_stiffness: 1, area_density: 3}
clamps: [{at: start}]
gravity: [0, 0, -2]
solver: {method: equilibrium}
)");
  constraint::Surroundings surroundings = scene.surroundings;
  const geometry::Ribbon ribbon = geometry::make_ribbon(scene.ribbon);
  for (const double moment : {0.5 * 3 * 0.1 * 2, 0.0}) {
    if (moment == 0) surroundings.gravity.setZero();
    const solver::PathProblem path = solver::make_path(ribbon, surroundings, {});
    solver::PathState state = solver::start_path(path);
    state.phase = solver::Phase::done;
    solver::NewtonWorkspace work;
    const std::optional<double> imbalance = solver::joint_imbalance(path, state, work);
    ASSERT_TRUE(imbalance.has_value());
    EXPECT_NEAR(*imbalance, moment, 1e-12);
  }
}

}  // namespace
}  // namespace wunderlich::scene
