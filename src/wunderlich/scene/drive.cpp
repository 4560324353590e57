#include "wunderlich/scene/drive.hpp"

#include <algorithm>

#include "wunderlich/math/rotation.hpp"

namespace wunderlich::scene {

namespace two_stage = solver::two_stage;

bool holds(const constraint::Support& support, double time) { return time < support.release * (1 - 1e-12); }

two_stage::Drive drive_between(const Scene& scene, const geometry::Ribbon& ribbon, const geometry::State& state,
                               double t0, double t1) {
  two_stage::Drive drive;
  drive.gravity = scene.surroundings.gravity;
  drive.surroundings = &scene.surroundings;
  for (const constraint::Support& support : scene.surroundings.supports) {
    if (!holds(support, t0)) continue;
    const Pose before = constraint::pose_at(support.motion, t0), after = constraint::pose_at(support.motion, t1);
    two_stage::Support held;
    held.node = support.node;
    held.hold_position = support.hold_position;
    held.position = after.position;
    held.orientation = support.orientation;
    held.segment = support.segment;
    // The two-stage method knows an end's own frame only where all of it is prescribed.
    if (support.segment < 0 && support.orientation == constraint::Orientation::about_tangent) {
      held.segment = std::min(support.node, ribbon.segments - 1);
    }
    held.frame = after.frame;
    held.turn = math::log_map(before.frame.conjugate() * after.frame)[2];
    drive.supports.push_back(held);
  }
  for (const constraint::Load& load : scene.surroundings.loads) {
    const constraint::LoadKey key = constraint::load_at(load, t1);
    const Quat frame = load.frame == constraint::LoadFrame::material ? geometry::node_frame(ribbon, state, load.node)
                                                                     : Quat(Quat::Identity());
    drive.loads.push_back({load.node, frame * key.force, frame * key.torque});
  }
  return drive;
}

}  // namespace wunderlich::scene
