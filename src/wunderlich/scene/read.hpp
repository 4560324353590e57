/// Reads scenes: files, shipped scenes, overrides.
///
/// Every function throws InputError with `file:line:column: key: value ... what is allowed` on bad input; what an
/// override gets wrong is reported as `--set key=value: ...`.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/scene/scene.hpp"

namespace wunderlich::scene {

/// A scene compiled into the program.
struct ShippedScene {
  std::string name;
  std::string text;
};

/// In alphabetic order.
const std::vector<ShippedScene>& shipped_scenes();

/// Reads a scene: a file, or the name of a shipped scene. A bare word is a shipped scene first; write `./word` for
/// a file of that name. `overrides` are `key.path=value` with a YAML value, applied in order.
Scene read_scene(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

/// Reads a scene from its text. `source` is the file name in messages; `Scene::name` is its stem.
Scene read_scene_text(const std::string& text, const std::string& source,
                      const std::vector<std::string>& overrides = {});

}  // namespace wunderlich::scene
