#include "two_stage/drops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/crossings.hpp"
#include "wunderlich/solver/two_stage/objective.hpp"

namespace wunderlich::testing {

void show(const char* name, double measured, double asked) {
  std::printf("  %-55s %.4g (asked: %.3g)\n", name, measured, asked);
}

double along(const two_stage::Row& row, const std::vector<two_stage::Vec7>& motion) {
  double sum = 0;
  for (std::size_t slot = 0; slot < two_stage::Row::kMost; ++slot) {
    if (row.block[slot] < 0) continue;
    sum += row.slope.col(static_cast<Eigen::Index>(slot)).dot(motion[static_cast<std::size_t>(row.block[slot])]);
  }
  return sum;
}

Loose loose(const geometry::Ribbon& ribbon, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Loose l{ribbon, {}, random_state(ribbon, random), {}, {}};
  if (ribbon.is_loop()) {
    l.shape.r.back() = l.shape.r.front();
    for (double& eta : l.shape.eta) eta *= 0.3;
    l.shape.eta.back() = ribbon.seam_sign() * l.shape.eta.front();
  }
  prepare(l.options, ribbon, {}, l.shape, l.work);
  two_stage::set_metric(ribbon, l.options, 1e-3, l.work);
  l.motion.assign(static_cast<std::size_t>(two_stage::block_count(ribbon)), two_stage::Vec7::Zero());
  for (std::size_t b = 0; b < l.motion.size(); ++b) {
    for (int k = 0; k < 7; ++k) {
      const double unit = k < 3 ? ribbon.rest_length.front() : 1;
      if (l.work.equations.inverse_metric[b][k] > 0) l.motion[b][k] = unit * normal(random);
    }
  }
  return l;
}

geometry::State moved(double h, Loose& l) {
  geometry::State out = l.shape;
  two_stage::move_all(l.ribbon, l.motion, h, l.work, out);
  return out;
}

constraint::Obstacle solid(const contact::Shape& shape, const Pose& pose, double friction) {
  constraint::Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.friction = friction;
  obstacle.motion.keys = {{0, pose, 0}};
  return obstacle;
}

void place(const Pose& base, Drop& d) {
  for (Vec3& r : d.c.state.shape.r) r = base.position + base.frame * r;
  for (Quat& q : d.c.state.shape.q) q = base.frame * q;
  for (Quat& q : d.c.state.shape.end_frame) q = base.frame * q;
}

Drop drop(double bending_stiffness, int segments, const std::vector<constraint::Obstacle>& solids,
          const Vec3& gravity) {
  Drop d;
  geometry::RibbonSpec spec;
  spec.length = 0.3;
  spec.width = kWidth;
  spec.segments = segments;
  spec.bending_stiffness = bending_stiffness;
  spec.area_density = 0.1;
  d.c.ribbon = geometry::make_ribbon(spec);
  d.c.state = two_stage::start(d.c.ribbon, geometry::straight_state(d.c.ribbon));
  d.c.drive.gravity = gravity;
  d.surroundings.obstacles = solids;
  d.surroundings.contact.distance = kWidth / 30;
  return d;
}

double clearance(const Drop& d) {
  const geometry::State& shape = d.c.state.shape;
  double least = 1e9;
  constexpr int kFine = 16;
  for (const constraint::Obstacle& obstacle : d.surroundings.obstacles) {
    const Pose pose = constraint::pose_at(obstacle.motion, shape.time);
    for (std::size_t s = 0; s < shape.q.size(); ++s) {
      const Mat3 frame = shape.q[s].toRotationMatrix();
      const auto at = [&](std::size_t node, double v) -> Vec3 {
        return shape.r[node] + v * (frame.col(1) + shape.eta[node] * frame.col(2));
      };
      const Vec3 middle = 0.5 * (shape.r[s] + shape.r[s + 1]);
      if (contact::distance(obstacle.shape, pose, middle).value > 1.5 * kWidth) continue;
      for (int k = 0; k <= kFine; ++k) {
        const double v = kWidth * (static_cast<double>(k) / kFine - 0.5);
        for (int i = 0; i <= kFine; ++i) {
          const double f = static_cast<double>(i) / kFine;
          const Vec3 point = (1 - f) * at(s, v) + f * at(s + 1, v);
          least = std::min(least, contact::distance(obstacle.shape, pose, point).value);
        }
      }
    }
  }
  return least - d.surroundings.contact.thickness;
}

solver::StripPlace placed(const Drop& d, geometry::Chain& chain, geometry::Kinematics& kinematics) {
  const geometry::State& shape = d.c.state.shape;
  chain.eta = shape.eta;
  kinematics.r = shape.r;
  kinematics.frame.clear();
  for (std::size_t i = 0; i < shape.r.size(); ++i) {
    kinematics.frame.push_back(shape.q[i == 0 ? 0 : i - 1].toRotationMatrix());
  }
  return {d.c.ribbon, chain, kinematics};
}

namespace {

/// Facets of the reconstructed surface that go through each other.
int crossings_now(const Drop& d) {
  geometry::Chain chain;
  geometry::Kinematics kinematics;
  const solver::StripPlace place = placed(d, chain, kinematics);
  return crossings({&place, 1});
}

/// One step; one that fails says why and is tried again in halves, as runs do.
bool advance(double dt, int halvings, Drop& d, two_stage::StepReport& report) {
  report = two_stage::step(d.c.ribbon, d.c.drive, d.c.options, dt, d.c.state, d.c.work);
  d.sweeps += report.contact_sweeps;
  if (report.accepted) {
    EXPECT_EQ(report.contact_unsettled, 0) << d.c.state.shape.time;
    EXPECT_GT(report.nearest, -0.01 * kWidth);
    return true;
  }
  EXPECT_FALSE(report.failure.empty());
  ++d.halvings;
  return halvings < 6 && advance(0.5 * dt, halvings + 1, d, report) && advance(0.5 * dt, halvings + 1, d, report);
}

}  // namespace

two_stage::StepReport go(double duration, double dt, int look, Drop& d) {
  d.c.drive.surroundings = &d.surroundings;
  two_stage::StepReport report;
  const long steps = std::lround(duration / dt);
  for (long k = 1; k <= steps; ++k) {
    const bool done = advance(dt, 0, d, report);
    EXPECT_TRUE(done) << report.failure << " at " << d.c.state.shape.time;
    if (!done) break;
    d.most_touching = std::max(d.most_touching, report.touching);
    if (k % look != 0) continue;
    d.nearest = std::min(d.nearest, clearance(d));
    d.crossings += crossings_now(d);
  }
  return report;
}

}  // namespace wunderlich::testing
