/// Strips among solids that the tests of contact in the two-stage method share, and what is looked at apart from it.
#pragma once

#include <random>

#include "support/random_state.hpp"
#include "two_stage/cases.hpp"
#include "wunderlich/solver/self_contact.hpp"
#include "wunderlich/solver/two_stage/contact_rows.hpp"

namespace wunderlich::testing {

inline constexpr double kGravity = 9.81;
inline constexpr double kWidth = 0.03;

void show(const char* name, double measured, double asked);

/// Slopes of a row times a motion.
double along(const two_stage::Row& row, const std::vector<two_stage::Vec7>& motion);

/// A ribbon off its constraints, and a motion of all that is not held.
struct Loose {
  geometry::Ribbon ribbon;
  two_stage::Options options;
  geometry::State shape;
  two_stage::Workspace work;
  std::vector<two_stage::Vec7> motion;
};

Loose loose(const geometry::Ribbon& ribbon, std::mt19937& random);
geometry::State moved(double h, Loose& l);

/// A strip of 0.3 m x 30 mm, 0.1 kg/m^2 among solids.
struct Drop {
  Case c;
  constraint::Surroundings surroundings;
  double nearest = 1e9;  ///< smallest distance of facets to solids, beyond the thickness, by the test's own points
  int crossings = 0;     ///< facets that go through each other, by trying all
  int most_touching = 0;
  long sweeps = 0;
  int halvings = 0;
};

constraint::Obstacle solid(const contact::Shape& shape, const Pose& pose, double friction = 0);

/// Moves a strip, as a whole, by a pose.
void place(const Pose& base, Drop& d);

Drop drop(double bending_stiffness, int segments, const std::vector<constraint::Obstacle>& solids, const Vec3& gravity);

/// Smallest distance of many points of each facet.
double clearance(const Drop& d);

/// The strip as the searches of the tests take it; what it refers to is in the two that are filled.
solver::StripPlace placed(const Drop& d, geometry::Chain& chain, geometry::Kinematics& kinematics);

/// Goes on for `duration`; looks at the facets every `look` steps. Returns the last report.
two_stage::StepReport go(double duration, double dt, int look, Drop& d);

}  // namespace wunderlich::testing
