// Random strips are thrown at random solids: nothing crashes, nothing goes through anything, and what fails says why.
// WUNDERLICH_DROPS: how many, WUNDERLICH_DROPS_FROM: the first seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>

#include "implicit/motions.hpp"
#include "solver/paths.hpp"
#include "wunderlich/math/rotation.hpp"

namespace wunderlich::testing {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kClear = 3e-3;  // m between the strip and solids at the start

/// The same numbers everywhere, which the library's distributions do not promise.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double in(double from, double to) { return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double log_in(double from, double to) { return std::exp(in(std::log(from), std::log(to))); }
  int whole(int from, int to) { return static_cast<int>(std::floor(in(from, to + 1))); }
  bool one_in(int n) { return whole(1, n) == 1; }
  Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Quat frame() { return math::exp_map(vector(kPi)); }

 private:
  std::mt19937_64 engine_;
};

/// Distance to a solid in its own frame, not below 0 for boxes and ends, written apart from the solver's.
double distance_to(const contact::Shape& shape, const Vec3& p) {
  if (std::holds_alternative<contact::HalfSpace>(shape)) return p.z();
  if (const auto* sphere = std::get_if<contact::Sphere>(&shape)) return p.norm() - sphere->radius;
  if (const auto* capsule = std::get_if<contact::Capsule>(&shape)) {
    const double z = std::clamp(p.z(), -capsule->half_length, capsule->half_length);
    return (p - Vec3(0, 0, z)).norm() - capsule->radius;
  }
  if (const auto* cylinder = std::get_if<contact::Cylinder>(&shape)) {
    const double out = std::hypot(p.x(), p.y()) - cylinder->radius;
    if (!std::isfinite(cylinder->half_length)) return out;
    return std::hypot(std::max(out, 0.0), std::max(std::abs(p.z()) - cylinder->half_length, 0.0));
  }
  if (const auto* box = std::get_if<contact::Box>(&shape)) return (p.cwiseAbs() - box->half_size).cwiseMax(0).norm();
  return 1e9;
}

/// Smallest distance of the strip's facets to the solids at a time, by many points of each.
double clearance(const geometry::Ribbon& ribbon, const geometry::State& shape,
                 const std::vector<constraint::Obstacle>& solids, double time) {
  constexpr int kFine = 12;
  double least = 1e9;
  for (const constraint::Obstacle& solid : solids) {
    const Pose pose = constraint::pose_at(solid.motion, time);
    const Mat3 to_own = pose.frame.conjugate().toRotationMatrix();
    for (std::size_t s = 0; s < shape.q.size(); ++s) {
      const Mat3 frame = shape.q[s].toRotationMatrix();
      for (int i = 0; i <= kFine; ++i) {
        const double f = static_cast<double>(i) / kFine, eta = (1 - f) * shape.eta[s] + f * shape.eta[s + 1];
        const Vec3 node = shape.r[s] + f * ribbon.rest_length[s] * frame.col(2);
        for (int k = 0; k <= kFine; ++k) {
          const double v = ribbon.width * (static_cast<double>(k) / kFine - 0.5);
          const Vec3 at = node + v * (frame.col(1) + eta * frame.col(2));
          least = std::min(least, distance_to(solid.shape, to_own * (at - pose.position)));
        }
      }
    }
  }
  return least;
}

contact::Shape random_shape(Dice& dice) {
  const double radius = dice.log_in(0.004, 0.1), half = dice.log_in(0.01, 0.5);
  switch (dice.whole(0, 4)) {
    case 0:
      return contact::HalfSpace{};
    case 1:
      return contact::Sphere{radius};
    case 2:
      return contact::Cylinder{radius, dice.one_in(2) ? half : std::numeric_limits<double>::infinity()};
    case 3:
      return contact::Capsule{radius, half};
    default:
      return contact::Box{Vec3(dice.in(0.01, 0.1), dice.in(0.01, 0.1), dice.in(0.01, 0.1))};
  }
}

/// Below the strip or beside it; a plane looks up more or less.
constraint::Obstacle random_solid(Dice& dice) {
  constraint::Obstacle solid;
  solid.shape = random_shape(dice);
  const bool plane = std::holds_alternative<contact::HalfSpace>(solid.shape);
  Pose pose{Vec3(dice.in(-0.15, 0.15), dice.in(-0.1, 0.1), dice.in(-0.3, 0.05)), dice.frame()};
  if (plane) pose.frame = math::exp_map(Vec3(dice.in(-0.6, 0.6), dice.in(-0.6, 0.6), 0));
  solid.motion.keys = {{0, pose, 0}};
  if (dice.one_in(3)) {
    pose.position += dice.vector(0.2);
    solid.motion.keys.push_back({dice.in(0.1, 0.4), pose, dice.in(-6, 6)});
  }
  solid.friction = dice.one_in(2) ? dice.in(0, 1) : 0;
  return solid;
}

std::string kinds(const std::vector<constraint::Obstacle>& solids) {
  static const char* const names[] = {"plane", "sphere", "cylinder", "capsule", "box"};
  std::string text = "beside";
  for (const constraint::Obstacle& solid : solids) text += std::string(" ") + names[solid.shape.index()];
  return text;
}

struct Drop {
  Motion motion;
  double dt = 0;
};

Drop random_drop(unsigned seed) {
  Dice dice(seed);
  geometry::RibbonSpec spec;
  spec.length = dice.in(0.15, 0.5);
  spec.width = spec.length / dice.in(5, 15);
  spec.segments = dice.whole(6, 40);
  spec.bending_stiffness = dice.log_in(1e-6, 1e-2);
  spec.area_density = dice.log_in(0.05, 0.5);
  constraint::Surroundings surroundings;
  surroundings.gravity = Vec3(0, 0, -9.81);
  surroundings.contact.distance = spec.width / dice.in(15, 60);
  surroundings.contact.thickness = dice.one_in(2) ? 0 : 2e-4;
  const geometry::Ribbon ribbon = geometry::make_ribbon(spec);
  geometry::Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), dice.frame()});
  const double bent = dice.one_in(2) ? dice.in(-5, 5) / spec.length : 0;
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    if (geometry::kappa_is_free(ribbon, static_cast<int>(i))) chain.kappa[i] = bent;
  }
  geometry::State shape = geometry::state_of(ribbon, chain, 0);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& r : shape.r) middle += r / static_cast<double>(shape.r.size());
  for (Vec3& r : shape.r) r -= middle;
  const int count = dice.whole(1, 4);
  for (int tries = 0; static_cast<int>(surroundings.obstacles.size()) < count && tries < 100; ++tries) {
    const constraint::Obstacle solid = random_solid(dice);
    // What has edges is far from what is far from the ball around it or from the capsule around a cylinder's rims.
    constraint::Obstacle seen = solid;
    if (const auto* box = std::get_if<contact::Box>(&solid.shape)) seen.shape = contact::Sphere{box->half_size.norm()};
    if (const auto* cylinder = std::get_if<contact::Cylinder>(&solid.shape))
      seen.shape = contact::Capsule{1.42 * cylinder->radius, cylinder->half_length};
    if (clearance(ribbon, shape, {seen}, 0) > kClear) surroundings.obstacles.push_back(solid);
  }
  const Vec3 velocity = dice.vector(1) - Vec3(0, 0, dice.in(0, 3)), spin = dice.vector(dice.one_in(2) ? 10 : 0);
  for (std::size_t i = 0; i < shape.r.size(); ++i) shape.r_dot[i] = velocity + spin.cross(shape.r[i]);
  Drop drop;
  drop.motion = make_motion(spec, surroundings);
  drop.motion.options.integrator = static_cast<implicit::Integrator>(dice.whole(0, 2));
  drop.dt = dice.log_in(5e-4, 1e-2);
  start(shape, spin, drop.motion);
  return drop;
}

bool is_finite(const Motion& m) {
  const geometry::State shape = implicit::shape_of(m.path, m.state);
  return std::all_of(shape.r.begin(), shape.r.end(), [](const Vec3& r) { return r.allFinite(); }) &&
         std::all_of(shape.r_dot.begin(), shape.r_dot.end(), [](const Vec3& v) { return v.allFinite(); });
}

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

TEST(Drops, Random) {
  const int count = from_environment("WUNDERLICH_DROPS", is_slow_build() ? 3 : 24);
  const int first = from_environment("WUNDERLICH_DROPS_FROM", 1);
  int failed = 0;
  double nearest = 1e9;
  for (int seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Drop drop = random_drop(static_cast<unsigned>(seed));
    Motion& m = drop.motion;
    const int steps = static_cast<int>(std::ceil(0.3 / drop.dt));
    double least = 1e9;
    bool moves = true;
    for (int i = 1; i <= steps && moves; ++i) {
      moves = move_to(drop.dt * i, m);
      least = std::min(least, clearance(m.path.ribbon, implicit::shape_of(m.path, m.state),
                                        m.path.surroundings.obstacles, m.state.strips[0].path.t));
    }
    EXPECT_TRUE(is_finite(m));
    EXPECT_GT(least, m.path.surroundings.contact.thickness) << kinds(m.path.surroundings.obstacles);
    nearest = std::min(nearest, least);
    if (moves) continue;
    ++failed;
    EXPECT_FALSE(m.failure.empty());
    std::printf("  seed %d, step of %g s: %s\n", seed, drop.dt,
                (m.failure + "; " + kinds(m.path.surroundings.obstacles)).c_str());
  }
  std::printf("  seeds %d to %d: %d failed and said why\n", first, first + count - 1, failed);
  show("smallest distance in random drops [m]", nearest, 0);
  EXPECT_LE(failed, 2 + count / 40);  // failing is allowed, but not often: 14 of 1000 did, which ones is up to rounding
}

}  // namespace
}  // namespace wunderlich::testing
