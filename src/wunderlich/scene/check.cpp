#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/scene/schema.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string join(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + "." + name;
}

/// A key whose last part is `name`, wherever it belongs.
std::string elsewhere(const std::string& name) {
  for (const Key& key : keys()) {
    const std::size_t dot = key.path.rfind('.');
    const bool in_list = key.path.find('*') != std::string::npos;
    if (dot != std::string::npos && !in_list && key.path.substr(dot + 1) == name) return key.path;
  }
  return "";
}

[[noreturn]] void fail_unknown(const Place& place, const std::string& path, const std::string& pattern,
                               const std::string& name) {
  const std::vector<std::string> siblings = names_below(pattern);
  std::string guess = elsewhere(name);
  if (guess.empty()) guess = nearest(name, siblings);
  const std::string hint = guess.empty() ? "" : fmt::format("; did you mean `{}`?", guess);
  const std::string where = pattern.empty() ? "at the top" : "in `" + path.substr(0, path.rfind('.')) + "`";
  fail(place, shown(path),
       fmt::format("unknown key{} Allowed {}: {}", hint.empty() ? "." : hint, where, joined(siblings)));
}

[[noreturn]] void fail_value(const Cell& cell, const Key& key, const std::string& note = "") {
  fail(cell.place, cell.path,
       fmt::format("{} is not allowed{}; must be {}", described(*cell.value), note, allowed(key)));
}

void check_number(const Cell& cell, const Key& key) {
  const Value& value = *cell.value;
  if (value.kind != Value::Kind::scalar) fail_value(cell, key);
  const bool with_pi = value.text.find("pi") != std::string::npos;
  if (value.quoted && !with_pi) fail_value(cell, key, " (a number is written without quotes)");
  if (key.type == Type::integer) {
    const auto whole = parse_whole(value.text);
    if (!whole || static_cast<double>(*whole) < key.low || static_cast<double>(*whole) > key.high)
      fail_value(cell, key);
    return;
  }
  const auto parsed = parse_number(value.text);
  if (!parsed) fail_value(cell, key);
  if (!std::isfinite(*parsed)) fail_value(cell, key, " (it is not finite)");
  if (!(*parsed >= key.low && *parsed <= key.high)) fail_value(cell, key);
}

void check_choice(const Cell& cell, const Key& key) {
  const Value& value = *cell.value;
  if (value.kind != Value::Kind::scalar) fail_value(cell, key);
  if (contains(key.choices, value.text)) return;
  const std::string guess = nearest(value.text, key.choices);
  fail_value(cell, key, guess.empty() ? "" : fmt::format("; did you mean `{}`?", guess));
}

void check_count(const Cell& cell, const Key& key, std::size_t least = 0) {
  const std::size_t size = cell.value->items.size();
  if (cell.value->kind != Value::Kind::list || size < least || static_cast<double>(size) > key.high)
    fail_value(cell, key);
}

void check_cell(const Cell& cell);

void check_map(const Cell& cell) {
  const Value& map = *cell.value;
  for (std::size_t i = 0; i < map.items.size(); ++i) {
    const std::string& name = map.names[i];
    const std::string path = join(cell.path, name);
    const std::string pattern = join(cell.pattern, name);
    // A `*` in the table stands for an index, which no map has.
    if (find_key(pattern) != nullptr && name.find('*') == std::string::npos) {
      check_cell({&map.items[i], path, pattern, map.items[i].place});
    } else {
      fail_unknown(map.name_places[i], path, cell.pattern, name);
    }
  }
}

void check_list_of_maps(const Cell& cell, const Key& key) {
  check_count(cell, key);
  for (std::size_t i = 0; i < cell.value->items.size(); ++i) {
    const Cell item = element(cell, i);
    if (item.value->kind != Value::Kind::map) {
      fail(item.place, item.path,
           fmt::format("{} is not allowed; must be a map with {}", described(*item.value),
                       joined(names_below(item.pattern))));
    }
    check_map(item);
  }
}

void check_place(const Cell& cell, const Key& key) {
  if (cell.value->kind != Value::Kind::map) return check_choice(cell, key);
  check_map(cell);
  if (cell.value->items.size() != 1) fail_value(cell, key);
}

void check_cell(const Cell& cell) {
  const Key& key = *find_key(cell.pattern);
  const Value& value = *cell.value;
  switch (key.type) {
    case Type::map:
      if (value.kind != Value::Kind::map) fail_value(cell, key);
      return check_map(cell);
    case Type::list:
      return check_list_of_maps(cell, key);
    case Type::place:
      return check_place(cell, key);
    case Type::choice:
      return check_choice(cell, key);
    case Type::number:
    case Type::integer:
      return check_number(cell, key);
    case Type::text:
      if (value.kind != Value::Kind::scalar || value.text.find('\n') != std::string::npos || value.text.size() > 200) {
        fail_value(cell, key);
      }
      return;
    case Type::lines:
      if (value.kind != Value::Kind::scalar || value.text.empty()) fail_value(cell, key);
      return;
    case Type::boolean:
      if (value.quoted || !contains({"true", "false"}, value.text)) fail_value(cell, key);
      return;
    case Type::vector:
      if (value.kind != Value::Kind::list || value.items.size() != 3) fail_value(cell, key);
      break;
    case Type::numbers:
      if (value.kind != Value::Kind::list) fail_value(cell, key);
      break;
    case Type::choices:
      check_count(cell, key);
      break;
  }
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const Cell item{&value.items[i], fmt::format("{}.{}", cell.path, i), cell.pattern, value.items[i].place};
    key.type == Type::choices ? check_choice(item, key) : check_number(item, key);
  }
}

std::string range(const Key& key) {
  if (key.type == Type::integer) return fmt::format("from {:.0f} to {:.0f}", key.low, key.high);
  return fmt::format("from {:g} to {:g}{}", key.low, key.high, key.unit.empty() ? "" : " " + key.unit);
}

}  // namespace

std::vector<std::string> names_below(const std::string& pattern) {
  const std::string prefix = pattern.empty() ? "" : pattern + ".";
  std::vector<std::string> names;
  for (const Key& key : keys()) {
    if (key.path.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string name = key.path.substr(prefix.size());
    if (name.find('.') == std::string::npos && name != "*") names.push_back(name);
  }
  return names;
}

std::string allowed(const Key& key) {
  switch (key.type) {
    case Type::map:
      return "a map with " + joined(names_below(key.path));
    case Type::list:
      return fmt::format("a list of at most {:g} maps with {}", key.high, joined(names_below(key.path + ".*")));
    case Type::text:
      return "one line of text, at most 200 bytes";
    case Type::lines:
      return "lines of text";
    case Type::number:
      return "a number " + range(key);
    case Type::integer:
      return "a whole number " + range(key);
    case Type::boolean:
      return "true or false";
    case Type::choice:
      return (key.choices.size() > 1 ? "one of " : "") + joined(key.choices);
    case Type::choices:
      return "a list of some of " + joined(key.choices);
    case Type::vector:
      return "a list of three numbers " + range(key);
    case Type::numbers:
      return "a list of numbers " + range(key);
    case Type::place:
      break;
  }
  std::string text = joined(key.choices) + ", or a map with exactly one of ";
  return text + joined(names_below(key.path));
}

void check_document(const Value& root) {
  if (root.kind != Value::Kind::map) {
    fail(root.place, "",
         fmt::format("a scene must be a map with keys such as {}; this is {}", joined(names_below("")),
                     root.kind == Value::Kind::null ? "empty" : described(root)));
  }
  check_map(root_cell(root));
}

}  // namespace wunderlich::scene
