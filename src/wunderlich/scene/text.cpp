#include "wunderlich/scene/text.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>

namespace wunderlich::scene {

namespace {

using std::numbers::pi;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads from the front of a text.
struct Cursor {
  std::string_view rest;

  void skip_spaces() {
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  }
  bool take(std::string_view token) {
    if (rest.substr(0, token.size()) != token) return false;
    rest.remove_prefix(token.size());
    return true;
  }
  std::size_t digits_at(std::size_t start) const {
    std::size_t end = start;
    while (end < rest.size() && is_digit(rest[end])) ++end;
    return end - start;
  }
};

/// Length of the decimal number at the front: digits, point, exponent; 0 when there is none.
std::size_t decimal_length(const Cursor& cursor) {
  const std::string_view s = cursor.rest;
  std::size_t end = cursor.digits_at(0);
  std::size_t digits = end;
  if (end < s.size() && s[end] == '.') {
    const std::size_t decimals = cursor.digits_at(end + 1);
    digits += decimals;
    end += 1 + decimals;
  }
  if (digits == 0) return 0;
  if (end < s.size() && (s[end] == 'e' || s[end] == 'E')) {
    std::size_t start = end + 1;
    if (start < s.size() && (s[start] == '+' || s[start] == '-')) ++start;
    const std::size_t exponent = cursor.digits_at(start);
    if (exponent > 0) end = start + exponent;
  }
  return end;
}

std::optional<double> decimal(std::string_view token) {
  std::istringstream stream{std::string(token)};
  stream.imbue(std::locale::classic());
  double value = 0;
  // The token is known to be a number, so failing means that it is too large.
  if (!(stream >> value)) return std::numeric_limits<double>::infinity();
  return value;
}

std::optional<double> factor(Cursor& cursor) {
  if (cursor.take("pi")) return pi;
  const std::size_t length = decimal_length(cursor);
  if (length == 0) return std::nullopt;
  const std::string_view token = cursor.rest.substr(0, length);
  cursor.rest.remove_prefix(length);
  return decimal(token);
}

/// Edits (insert, delete, replace, swap neighbours) between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

/// Bytes of the UTF-8 character at `i`; 0 when it is malformed, overlong, a surrogate or a control character.
std::size_t character_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(k < text.size() ? text[k] : 0); };
  const std::uint8_t lead = byte(i);
  if (lead < 0x80) return (lead >= 0x20 && lead != 0x7f) || lead == '\n' || lead == '\r' || lead == '\t' ? 1 : 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xc0) != 0x80) return 0;
  }
  const std::uint8_t second = byte(i + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool outside = (lead == 0xed && second > 0x9f) || (lead == 0xf4 && second > 0x8f);
  return overlong || outside ? 0 : length;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  Cursor cursor{text};
  cursor.skip_spaces();
  const double sign = cursor.take("-") ? -1 : 1;
  if (sign > 0) cursor.take("+");
  std::optional<double> value = factor(cursor);
  while (value) {
    cursor.skip_spaces();
    if (cursor.rest.empty()) return sign * *value;
    const bool divide = cursor.take("/");
    const bool implicit = !divide && !cursor.take("*");
    cursor.skip_spaces();
    if (implicit && cursor.rest.substr(0, 2) != "pi") return std::nullopt;
    const std::optional<double> next = factor(cursor);
    if (!next) return std::nullopt;
    value = divide ? *value / *next : *value * *next;
  }
  return std::nullopt;
}

std::optional<long> parse_whole(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  if (text.empty() || text.size() > 15 || !std::all_of(text.begin(), text.end(), is_digit)) return std::nullopt;
  long value = 0;
  for (const char c : text) value = 10 * value + (c - '0');
  return negative ? -value : value;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, std::min<std::size_t>(word.size(), 40) / 3) + 1;
  if (word.size() > 40) return best;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string shown(std::string_view text, std::size_t longest) {
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    if (line.size() + length > longest) return line + "...";
    const bool plain = length > 1 || (length == 1 && static_cast<unsigned char>(text[i]) >= 0x20);
    line += plain ? std::string(text.substr(i, length)) : length == 1 ? " " : "?";
    i += std::max<std::size_t>(length, 1);
  }
  return line;
}

std::optional<std::size_t> first_bad_byte(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return std::nullopt;
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

}  // namespace wunderlich::scene
