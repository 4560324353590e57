#include "wunderlich/scene/start.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "wunderlich/base/error.hpp"
#include "wunderlich/geometry/chain.hpp"
#include "wunderlich/scene/recording.hpp"
#include "wunderlich/scene/run.hpp"
#include "wunderlich/solver/chain_contact.hpp"
#include "wunderlich/solver/equilibrium.hpp"

namespace wunderlich::scene {

using constraint::Orientation;
using constraint::Support;
using geometry::Ribbon;
using geometry::State;

namespace {

Pose undeformed_pose(const Support& support, const Ribbon& ribbon, const State& straight) {
  const std::size_t segment = support.segment >= 0
                                  ? static_cast<std::size_t>(support.segment)
                                  : static_cast<std::size_t>(std::min(support.node, ribbon.segments - 1));
  return {straight.r[static_cast<std::size_t>(support.node)], straight.q[segment]};
}

/// A load that grows from nothing.
constraint::Load growing(int node, constraint::LoadFrame frame, const Vec3& force, const Vec3& torque) {
  return {node, frame, {{0, Vec3::Zero(), Vec3::Zero()}, {1, force, torque}}};
}

/// What the surroundings are at time 0, reached from the undeformed strip: supports move there, loads and weight grow.
/// Without supports there are none of them.
constraint::Surroundings at_start(const constraint::Surroundings& surroundings, const Ribbon& ribbon) {
  const State straight = geometry::straight_state(ribbon);
  constraint::Surroundings out = surroundings;
  for (Support& support : out.supports) {
    constraint::PoseKey goal = support.motion.keys.front();
    goal.time = 1;
    support.motion.keys = {{0, undeformed_pose(support, ribbon, straight), 0}, goal};
    if (ribbon.is_loop()) support.motion.keys = {goal};
  }
  out.gravity.setZero();
  if (surroundings.supports.empty()) {  // nothing would hold it
    out.loads.clear();
    return out;
  }
  for (constraint::Load& load : out.loads) {
    const constraint::LoadKey key = constraint::load_at(load, 0);
    load = growing(load.node, load.frame, key.force, key.torque);
  }
  for (int i = 0; i <= ribbon.segments && !surroundings.gravity.isZero(0); ++i) {
    const Vec3 weight = ribbon.node_mass[static_cast<std::size_t>(i)] * surroundings.gravity;
    out.loads.push_back(growing(i, constraint::LoadFrame::space, weight, Vec3::Zero()));
  }
  return out;
}

/// At rest at the end of a loading path, or, for a loop, where it has just been closed.
Start along_path(const Scene& scene, const Ribbon& ribbon) {
  solver::PathOptions options;
  options.model = scene.solver.energy;
  options.loop_path = scene.solver.loop_path;
  const solver::PathProblem path = solver::make_path(ribbon, at_start(scene.surroundings, ribbon), options);
  solver::PathState state = solver::start_path(path);
  solver::NewtonWorkspace work;
  const bool closing = scene.initial.shape == InitialShape::closed;
  constexpr int kMaxFailures = 200;
  for (int failures = 0; state.phase != solver::Phase::done;) {
    if (closing && state.closed) break;
    const solver::PathStep step = solver::advance(path, state, work);
    failures = step.accepted ? 0 : failures + 1;
    if (step.exhausted || failures > kMaxFailures) return {{}, "its start was not reached: " + step.failure};
  }
  Start start{geometry::state_of(solver::ribbon_of(path, state), state.chain, 0), ""};
  start.failure = lost_turns(path, state, start.shape);
  return start;
}

/// Moves the whole strip: what is at one place goes to the other.
void move(const Pose& from, const Pose& to, State& state) {
  const Quat turn = to.frame * from.frame.conjugate();
  for (Vec3& r : state.r) r = to.position + turn * (r - from.position);
  for (Quat& q : state.q) q = turn * q;
  for (Quat& q : state.end_frame) q = turn * q;
}

/// Moves the whole strip so that its first support is where it is held at time 0.
void bring_to_supports(const Scene& scene, const Ribbon& ribbon, State& state) {
  if (scene.surroundings.supports.empty()) return;
  const Support& support = scene.surroundings.supports.front();
  const Pose goal = constraint::pose_at(support.motion, 0);
  Pose now = undeformed_pose(support, ribbon, state);
  if (support.segment < 0 && support.orientation == Orientation::full) {
    now.frame = state.end_frame[support.node == 0 ? 0 : 1];
  }
  const bool turns = support.orientation == Orientation::full;
  move(now, {goal.position, turns ? goal.frame : now.frame}, state);
}

/// A coil of constant curvature and ruling slope: a ring, a spiral staircase. Exactly isometric.
State coil(const Scene& scene, const Ribbon& ribbon) {
  const State straight = geometry::straight_state(ribbon);
  geometry::Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), straight.q.front()});
  const double eta = scene.initial.slope;
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const int node = static_cast<int>(i);
    if (geometry::kappa_is_free(ribbon, node)) chain.kappa[i] = 1 / (scene.initial.radius * (1 + eta * eta));
    if (geometry::eta_is_free(ribbon, node)) chain.eta[i] = eta;
  }
  return geometry::state_of(ribbon, chain, 0);
}

/// Curvature and slope at a share of the length.
ProfileRow interpolate(const std::vector<ProfileRow>& rows, double at) {
  if (at <= rows.front().at) return rows.front();
  if (at >= rows.back().at) return rows.back();
  std::size_t i = 1;
  while (rows[i].at < at) ++i;
  const ProfileRow &a = rows[i - 1], &b = rows[i];
  const double f = (at - a.at) / (b.at - a.at);
  return {at, (1 - f) * a.curvature + f * b.curvature, (1 - f) * a.slope + f * b.slope};
}

/// Bent as given. Exactly isometric as well.
State profiled(const Scene& scene, const Ribbon& ribbon) {
  const State straight = geometry::straight_state(ribbon);
  geometry::Chain chain = geometry::straight_chain(ribbon, {Vec3::Zero(), straight.q.front()});
  for (std::size_t i = 0; i < chain.kappa.size(); ++i) {
    const int node = static_cast<int>(i);
    const ProfileRow row = interpolate(scene.initial.profile, ribbon.node_u[i] / ribbon.length);
    if (geometry::kappa_is_free(ribbon, node)) chain.kappa[i] = row.curvature;
    if (geometry::eta_is_free(ribbon, node)) chain.eta[i] = row.slope;
  }
  return geometry::state_of(ribbon, chain, 0);
}

Start shape_of(const Scene& scene, const Ribbon& ribbon) {
  switch (scene.initial.shape) {
    case InitialShape::straight:
      return {geometry::straight_state(ribbon), ""};
    case InitialShape::coil:
      return {coil(scene, ribbon), ""};
    case InitialShape::profile:
      return {profiled(scene, ribbon), ""};
    case InitialShape::equilibrium:
    case InitialShape::closed:
      return along_path(scene, ribbon);
  }
  return {};
}

void set_velocity(const InitialState& initial, const Ribbon& ribbon, State& state) {
  Vec3 center = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < state.r.size(); ++i) {
    center += ribbon.node_mass[i] * state.r[i];
    mass += ribbon.node_mass[i];
  }
  center /= mass;
  for (std::size_t i = 0; i < state.r.size(); ++i) {
    state.r_dot[i] = initial.velocity + initial.spin.cross(state.r[i] - center);
  }
}

}  // namespace

Start start_of(const Scene& scene, const Ribbon& ribbon) {
  Start start = shape_of(scene, ribbon);
  if (!start.failure.empty()) return start;
  const bool placed = scene.initial.shape == InitialShape::equilibrium || ribbon.is_loop();
  if (!placed) bring_to_supports(scene, ribbon, start.shape);
  if (scene.initial.place) move({start.shape.r.front(), start.shape.q.front()}, *scene.initial.place, start.shape);
  start.shape.time = 0;
  set_velocity(scene.initial, ribbon, start.shape);
  return start;
}

bool meet(const Scene& scene, const std::vector<State>& shapes) {
  if (!scene.surroundings.contact.self) return false;
  const std::vector<const Scene*> strips = strips_of(scene);
  std::vector<Ribbon> ribbons;
  std::vector<geometry::Chain> chains;
  std::vector<geometry::Kinematics> kinematics(strips.size());
  std::vector<solver::StripPlace> places;
  ribbons.reserve(strips.size()), chains.reserve(strips.size());  // places refer to them
  solver::SelfContact all;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    ribbons.push_back(motion_ribbon(*strips[i], 0));
    chains.push_back(geometry::chain_of(ribbons[i], shapes[i]));
    geometry::forward_kinematics(ribbons[i], chains[i], kinematics[i]);
    places.push_back({ribbons[i], chains[i], kinematics[i]});
    solver::SelfContact self;
    const constraint::Surroundings& surroundings = strips[i]->surroundings;
    solver::place_self(ribbons[i], surroundings, surroundings.contact.distance, true, chains[i].eta, self);
    solver::place_beside(self, all);
  }
  solver::SelfSearch search;
  solver::SelfContacts contacts;
  solver::find_pairs(places, all, search, contacts);
  return solver::smallest_distance(all, contacts) <= 0 || solver::count_crossings(all, contacts, search) > 0;
}

namespace {

/// Other starts are not known before the run.
bool start_is_known(const Scene& scene) {
  return scene.solver.method == Method::equilibrium || scene.initial.shape == InitialShape::straight ||
         scene.initial.shape == InitialShape::coil || scene.initial.shape == InitialShape::profile;
}

/// Distance of the strip to the only solid, by its points or exactly, and what must be there at least for the facet
/// that lacks most of it [m].
std::pair<double, double> plain_distance(const solver::ContactProblem& contact, const solver::ContactPoints& points) {
  double lacks = solver::mesh_distance(contact.meshes, points.meshes), kept = contact.thickness;
  double distance = lacks + contact.thickness;
  for (const solver::ContactFacet& facet : points.facets) {
    if (facet.least > lacks) continue;
    lacks = facet.least;
    kept = facet.kept;
  }
  for (const Vec3& at : points.at) {
    distance = std::min(distance, contact::distance(contact.solids.front().shape, at).value);
  }
  return {distance, kept};
}

void check_obstacles(const Scene& scene) {
  const constraint::Surroundings& surroundings = scene.surroundings;
  const geometry::Ribbon ribbon = motion_ribbon(scene, 0);
  if (surroundings.obstacles.empty()) return;
  const geometry::Chain chain = scene.solver.method == Method::equilibrium
                                    ? solver::start_path(solver::make_path(ribbon, surroundings, {})).chain
                                    : geometry::chain_of(ribbon, start_of(scene, ribbon).shape);
  geometry::Kinematics kinematics;
  geometry::forward_kinematics(ribbon, chain, kinematics);
  for (std::size_t i = 0; i < surroundings.obstacles.size(); ++i) {
    constraint::Surroundings one = surroundings;
    one.obstacles = {surroundings.obstacles[i]};
    solver::ContactProblem contact;
    solver::place_solids(ribbon, one, 0, contact);
    solver::ContactPoints points;
    solver::find_points(ribbon, contact, chain, kinematics, points);
    if (solver::is_inside_mesh(contact.meshes, points.meshes)) {
      throw InputError(scene.obstacle_places[i] + ": the strip starts inside; it must be outside all of its triangles");
    }
    if (solver::smallest_distance(contact, points) > 0) continue;
    const auto [distance, kept] = plain_distance(contact, points);
    throw InputError(fmt::format("{}: the strip starts {:.3g} m {}; it must be more than {:.3g} m away from it",
                                 scene.obstacle_places[i], std::abs(distance), distance < 0 ? "inside" : "from it",
                                 kept));
  }
}

}  // namespace

void check_start(const Scene& scene) {
  const std::vector<const Scene*> strips = strips_of(scene);
  if (!std::all_of(strips.begin(), strips.end(), [](const Scene* strip) { return start_is_known(*strip); })) return;
  for (const Scene* strip : strips) check_obstacles(*strip);
  if (!scene.surroundings.contact.self || scene.solver.method == Method::equilibrium) return;
  std::vector<State> shapes;
  for (const Scene* strip : strips) {
    Start start = start_of(*strip, motion_ribbon(*strip, 0));
    if (!start.failure.empty()) throw InputError(scene.contact_place + ": " + start.failure);
    shapes.push_back(std::move(start.shape));
  }
  if (!meet(scene, shapes)) return;
  throw InputError(scene.contact_place + ": " +
                   (strips.size() > 1 ? "the strips start across themselves or one another"
                                      : "the strip starts across itself or touches itself"));
}

}  // namespace wunderlich::scene
