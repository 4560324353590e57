/// Strips and states that the tests of both shells share.
#pragma once

#include "wunderlich/baseline/shell/step.hpp"

namespace wunderlich::baseline::shell {

enum class Kind { conforming, nonconforming };

Shell make(Kind kind, const geometry::RibbonSpec& strip, int along, int across);

/// Points of the shell when its vertices are carried by `place` of (u, v).
Points placed(const Shell& shell, Kind kind, Vec3 (*place)(const Vec2&));

/// The flat strip, each coordinate moved by up to `size` at random.
Points shaken(const Shell& shell, unsigned seed, double size);

/// A support that holds the frame of an end node of the straight strip, at rest.
constraint::Support clamp_at(const geometry::RibbonSpec& strip, bool end);

}  // namespace wunderlich::baseline::shell
