#include "scene/placed.hpp"

#include "wunderlich/scene/recording.hpp"

namespace wunderlich::scene {

void place(const Scene& scene, const Record& record, Placed& out) {
  const std::vector<const Scene*> strips = strips_of(scene);
  out = {};
  out.ribbons.reserve(strips.size());
  out.whole.reserve(strips.size());
  out.chains.reserve(strips.size());
  out.kinematics.resize(strips.size());
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const geometry::State& state = record.states[i];
    const bool path = scene.solver.method == Method::equilibrium;
    out.ribbons.push_back(path ? path_ribbon(*strips[i], state) : motion_ribbon(*strips[i], state.time));
    out.chains.push_back(geometry::chain_of(out.ribbons[i], state));
    geometry::forward_kinematics(out.ribbons[i], out.chains[i], out.kinematics[i]);
    out.whole.push_back(geometry::make_ribbon(strips[i]->ribbon));
    out.places.push_back({out.whole[i], out.chains[i], out.kinematics[i]});
  }
}

}  // namespace wunderlich::scene
