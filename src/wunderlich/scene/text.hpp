/// Small things about text that the scene reader needs: numbers, near misses, checks of encoding.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wunderlich::scene {

/// A number as scenes write it: a decimal number, or products and quotients of numbers and `pi`
/// (`2.5`, `-1e-3`, `pi`, `-pi/2`, `2pi`, `5/2 pi`, `5*pi/4`). Nothing else, in any locale; the result may be
/// infinite (`1e999`, `1/0`).
std::optional<double> parse_number(std::string_view text);

/// Decimal digits with an optional sign; nothing when it is not that or does not fit.
std::optional<long> parse_whole(std::string_view text);

/// The candidate that a mistyped word most likely meant; empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// A value quoted in a message: one line, no control characters, cut after `longest` bytes.
std::string shown(std::string_view text, std::size_t longest = 60);

/// Position of the first byte that is no valid UTF-8 text (or a control character), if there is one.
std::optional<std::size_t> first_bad_byte(std::string_view text);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

}  // namespace wunderlich::scene
