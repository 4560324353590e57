#include "session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "wunderlich/scene/read.hpp"

namespace wunderlich::web {
namespace {

constexpr double kLong = 1e9;  // milliseconds

/// A cantilever of 20 segments, clamped level at its start; `gravity` along z.
scene::Scene cantilever(double gravity = -5) {
  return scene::read_scene_text(
      "{ribbon: {length: 1, width: 0.1, segments: 20}, clamps: [{at: start}], solver: {method: equilibrium}, gravity: "
      "[0, 0, " +
          std::to_string(gravity) + "]}",
      "cantilever");
}

/// At rest, from where its motion begins.
Session at_rest() {
  Session session(cantilever());
  EXPECT_FALSE(session.follow(kLong));
  return session;
}

/// So many of the longest steps; all must succeed.
void go(Session& session, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(session.step(session.step_length())) << session.failure();
}

const geometry::State& state(const Session& session) { return session.states().front(); }
Vec3 tip(const Session& session) { return state(session).r.back(); }

double mean_torsion(const Session& session) {
  double sum = 0;
  const auto line = session.frame().centerline;
  for (const CenterlineSample& node : line) sum += node.tau;
  return sum / static_cast<double>(line.size());
}

double length(const geometry::State& s) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < s.r.size(); ++i) sum += (s.r[i + 1] - s.r[i]).norm();
  return sum;
}

TEST(Session, GoesToRestFirstAndThenMoves) {
  Session session(cantilever());
  EXPECT_TRUE(session.on_path());
  EXPECT_FALSE(session.step(0.01));
  session.grab(0, 20);
  EXPECT_FALSE(session.holds());
  EXPECT_FALSE(session.follow(kLong));
  EXPECT_FALSE(session.on_path());
  ASSERT_TRUE(session.summary().has_value());
  EXPECT_TRUE(session.summary()->converged);
  EXPECT_EQ(session.failure(), "");
  const Vec3 rest = tip(session);
  go(session, 60);
  EXPECT_NEAR(session.time(), 60 * session.step_length(), 1e-12);
  EXPECT_LT((tip(session) - rest).norm(), 1e-6);
}

TEST(Session, AMotionBeginsAtOnce) {
  Session session(
      scene::read_scene("cantilever", {"solver.method=implicit", "solver.time_step=0.01", "ribbon.segments=20"}));
  EXPECT_FALSE(session.on_path());
  const Vec3 start = tip(session);
  go(session, 10);
  EXPECT_LT(tip(session).z(), start.z() - 1e-3);
}

TEST(Session, AHandPullsAFreePlaceAndLetsGo) {
  Session session = at_rest();
  const Vec3 rest = tip(session);
  session.grab(0, 20);
  ASSERT_TRUE(session.holds());
  go(session, 30);
  EXPECT_LT((tip(session) - rest).norm(), 1e-2) << "what is held stays, until it is dragged";
  session.drag(rest + Vec3(0, 0, 0.2));
  go(session, 240);
  EXPECT_GT(tip(session).z(), rest.z() + 0.1);
  EXPECT_LT(session.history().area_error, 1e-12);
  session.let_go();
  EXPECT_FALSE(session.holds());
  go(session, 600);
  EXPECT_LT((tip(session) - rest).norm(), 1e-3) << "it comes to rest again where it was";
}

TEST(Session, AHandMovesASupportNoFasterThanAStripFollows) {
  Session session = at_rest();
  session.grab(0, 0);
  const Vec3 start = state(session).r.front(), target = start + Vec3(0.05, 0.1, 0);
  session.drag(target);
  go(session, 1);
  const double first = (state(session).r.front() - start).norm();
  EXPECT_NEAR(first, 2.5 / 120, 1e-9);  // lengths a second shown, 120 steps a second
  go(session, 30);
  EXPECT_LT((state(session).r.front() - target).norm(), 1e-9);
}

TEST(Session, AHandTwistsToBothSides) {
  for (const double angle : {0.6, -0.6}) {
    Session session = at_rest();
    session.grab(0, 20);
    session.turn(angle);
    go(session, 60);
    EXPECT_GT(mean_torsion(session) * angle, 0.1) << angle;
  }
}

TEST(Session, SettingsTakeEffect) {
  Session session = at_rest();
  const double rest = tip(session).z();
  Settings wanted = session.settings();
  wanted.length = 1.1, wanted.width = 0.08, wanted.stiffness = 2, wanted.damping = 5;
  wanted.gravity = Vec3(0, 0, -1);
  session.set(wanted);
  go(session, 300);
  const geometry::RibbonSpec& ribbon = session.scene().ribbon;
  EXPECT_NEAR(ribbon.length, 1.1, 1e-9);
  EXPECT_NEAR(ribbon.width, 0.08, 1e-9);
  EXPECT_NEAR(ribbon.bending_stiffness, 2, 1e-9);
  EXPECT_EQ(session.scene().solver.implicit.drag_normal, 5);
  EXPECT_EQ(session.scene().surroundings.gravity, wanted.gravity);
  EXPECT_NEAR(length(state(session)), 1.1, 1e-9);
  EXPECT_GT(tip(session).z(), rest + 0.2) << "stiffer and lighter it hangs less";
}

TEST(Session, TheFarEndIsTwistedByASetting) {
  Session session = at_rest();
  Settings wanted = session.settings();
  wanted.twist = 0.5;
  session.set(wanted);
  go(session, 60);
  EXPECT_GT(mean_torsion(session), 0.1);
}

/// As far as the slider goes: the strip winds up, writhes and slips off, as a strip does. A step in a thousand may fail
/// on that way, and does no harm; let go it hangs as it did.
TEST(Session, AFreeEndIsTwistedThreeTurnsAndBack) {
  Session session = at_rest();
  const Vec3 rest = tip(session);
  Settings wanted = session.settings();
  double most = 0;
  int failed = 0;
  for (const double twist : {18.8, 0.0}) {
    wanted.twist = twist;
    session.set(wanted);
    for (int i = 0; i < 1200; ++i) {
      if (!session.step(session.step_length())) {
        ++failed;
        session.set(wanted);
      }
      most = std::max(most, mean_torsion(session));
    }
  }
  EXPECT_LE(failed, 3);
  EXPECT_GT(most, 2);
  go(session, 2400);
  EXPECT_LT((tip(session) - rest).norm(), 0.02);
}

/// The spring between hand and strip would snap if the hand came half a turn ahead.
TEST(Session, AHandThatTwistsWithoutEndDoesNoHarm) {
  Session session = at_rest();
  session.grab(0, 20);
  double most = 0;
  for (int i = 0; i < 2000; ++i) {
    session.turn(0.13);
    ASSERT_TRUE(session.step(session.step_length())) << session.failure();
    most = std::max(most, session.history().energy.kinetic);
  }
  EXPECT_LT(most, 10) << "bending the strip to a circle takes 0.5 (2 pi)^2 D w/l = 2 J";
  EXPECT_LT(session.history().constraints.max_ruling_ratio, 1);
  session.let_go();
  go(session, 60);
}

TEST(Session, AStepThatFailsKeepsTheLastGoodStateAndGoesOn) {
  Session session = at_rest();
  session.grab(0, 20);
  session.drag(Vec3(0.5, 0.5, 0.5));
  go(session, 5);
  const Settings given = session.settings();
  Settings absurd = given;
  absurd.gravity = Vec3(0, 0, -1e300);
  session.set(absurd);
  const double before = session.time();
  EXPECT_FALSE(session.step(session.step_length()));
  EXPECT_NE(session.failure(), "");
  EXPECT_FALSE(session.holds());
  EXPECT_GE(session.time(), before);
  EXPECT_LT(session.time(), before + session.step_length());
  EXPECT_LT(session.history().area_error, 1e-12);
  EXPECT_EQ(session.history().energy.kinetic, 0);
  session.set(given);
  go(session, 60);
  EXPECT_EQ(session.failure(), "");
}

/// The setting is asked for until it goes no further; every step succeeds, and the strip stays a strip.
void shortens_as_far_as_it_can(const std::string& name, double least) {
  Session session(scene::read_scene(name, {}));
  ASSERT_FALSE(session.follow(kLong));
  const double given = session.settings().length;
  Settings half = session.settings();
  half.length *= 0.5;
  session.set(half);
  std::string remark;
  for (int i = 0; i < 150; ++i) {
    session.step(session.step_length());
    if (!session.failure().empty()) remark = session.failure();
    ASSERT_TRUE(std::isfinite(session.history().energy.elastic)) << name << ", step " << i;
  }
  EXPECT_EQ(remark.empty(), std::abs(session.settings().length - 0.5 * given) < 1e-9) << name << " stops and says why";
  EXPECT_GE(session.settings().length, least) << name;
  EXPECT_LT(session.history().area_error, 1e-12) << name;
  half = session.settings();
  half.length = given;
  session.set(half);
  go(session, 100);
  EXPECT_NEAR(session.settings().length, given, 1e-9) << name;
}

TEST(Session, AStripIsNoShorterThanItsShapeAndItsSupportsAllow) {
  shortens_as_far_as_it_can("buckled-strip", 0.8);  // what lies between its clamps
  shortens_as_far_as_it_can("twist-pi", 0.5);       // its rulings nearly meet
  shortens_as_far_as_it_can("coil", 0.5);
  shortens_as_far_as_it_can("drape-cylinder", 0.15);
}

TEST(Session, APathThatFailsSaysWhyAndStays) {
  Session session(scene::read_scene("moebius", {"ribbon.aspect=1.8"}));
  EXPECT_FALSE(session.follow(kLong));
  EXPECT_TRUE(session.on_path()) << "a loop that has not closed does not go on";
  EXPECT_NE(session.failure(), "");
  EXPECT_FALSE(session.summary()->converged);
  EXPECT_FALSE(session.step(session.step_length()));
  EXPECT_FALSE(session.film().frames.empty());
}

TEST(Session, TheFilmHasTheLastSeconds) {
  Session session = at_rest();
  const std::size_t path = session.film().frames.size();
  EXPECT_GT(path, 1U) << "the path, while nothing has moved";
  go(session, 60);
  EXPECT_LT(session.film().frames.size(), 10U);
  go(session, 1200);
  const std::vector<Frame> film = session.film().frames;
  EXPECT_GT(film.size(), 60U);
  EXPECT_LT(film.size(), 80U);
  for (std::size_t i = 0; i + 1 < film.size(); ++i) EXPECT_LT(film[i].time, film[i + 1].time);
  EXPECT_NEAR(film.back().time, session.time(), 1e-12);
}

TEST(Session, TheFilmOfAPathHasItsSolidsWhereTheyWere) {
  Session session(
      scene::read_scene("cantilever", {"ribbon.segments=20",
                                       "obstacles=[{shape: sphere, radius: 0.1, position: [0, 3, 0], keyframes: "
                                       "[{time: 0}, {time: 1, position: [0, 4, 0]}]}]"}));
  EXPECT_FALSE(session.follow(kLong));
  const Film film = session.film();
  ASSERT_EQ(film.bodies.size(), 1U);
  ASSERT_EQ(film.bodies[0].poses.size(), film.frames.size());
  EXPECT_EQ(film.bodies[0].poses.front().position.y(), 3);
  EXPECT_EQ(film.bodies[0].poses.back().position.y(), 4);
}

}  // namespace
}  // namespace wunderlich::web
