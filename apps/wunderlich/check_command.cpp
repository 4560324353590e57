#include <fmt/format.h>

#include <iostream>

#include "commands.hpp"
#include "wunderlich/scene/read.hpp"
#include "wunderlich/scene/run.hpp"
#include "wunderlich/scene/schema.hpp"

namespace wunderlich::app {

int check_command(const std::string& scene_name, const std::vector<std::string>& set) {
  const scene::Scene scene = scene::read_scene(scene_name, set);
  scene::check_start(scene);
  for (const scene::Scene* strip : scene::strips_of(scene)) {
    const bool loop = strip->ribbon.closure == geometry::Closure::loop;
    const std::string name = strip->ribbon_name.empty() ? "" : " ribbon `" + strip->ribbon_name + "`:";
    std::cout << fmt::format("{}: ok:{} {}, {} segments, l/w = {:g}, {} supports, {} loads\n", scene.name, name,
                             loop ? "a loop" : "an open strip", strip->ribbon.segments,
                             strip->ribbon.length / strip->ribbon.width, strip->surroundings.supports.size(),
                             strip->surroundings.loads.size());
  }
  return done;
}

int scenes_command() {
  std::size_t widest = 0;
  for (const auto& shipped : scene::shipped_scenes()) widest = std::max(widest, shipped.name.size());
  for (const auto& shipped : scene::shipped_scenes()) {
    std::cout << fmt::format("{:{}}  {}\n", shipped.name, widest, scene::read_scene(shipped.name).title);
  }
  return done;
}

int schema_command(bool json) {
  std::cout << (json ? scene::schema_json() : scene::schema_markdown());
  return done;
}

}  // namespace wunderlich::app
