/// Bounds of numbers in a scene that keep every product of a few of them finite; far beyond any strip one could build.
/// Internal to the tables of keys.
#pragma once

namespace wunderlich::scene::bound {

inline constexpr double far = 1e9;         ///< [m]
inline constexpr double tiny = 1e-6;       ///< [m]
inline constexpr double strong = 1e12;     ///< [N], [N m]
inline constexpr double long_time = 1e9;   ///< [s]
inline constexpr double many_turns = 1e4;  ///< [rad]

}  // namespace wunderlich::scene::bound
