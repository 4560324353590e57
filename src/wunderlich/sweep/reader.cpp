#include "wunderlich/sweep/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wunderlich/scene/text.hpp"

namespace wunderlich::sweep {

using scene::Value;

void refuse(const Node& node, const std::string& problem) { scene::fail(node.place, node.path, problem); }

void require_keys(const Node& map, const std::vector<std::string>& allowed) {
  if (map.value->kind != Value::Kind::map) {
    refuse(map, fmt::format("{} is not allowed; must be a map with {}", described(*map.value), scene::joined(allowed)));
  }
  for (std::size_t i = 0; i < map.value->names.size(); ++i) {
    const std::string& name = map.value->names[i];
    if (std::find(allowed.begin(), allowed.end(), name) != allowed.end()) continue;
    const std::string guess = scene::nearest(name, allowed);
    const std::string path = map.path.empty() ? name : map.path + "." + name;
    scene::fail(map.value->name_places[i], scene::shown(path),
                fmt::format("unknown key{} Allowed: {}",
                            guess.empty() ? "." : fmt::format("; did you mean `{}`?", guess), scene::joined(allowed)));
  }
}

Node child(const Node& map, const std::string& name) {
  const Value* value = map.value != nullptr ? map.value->find(name) : nullptr;
  return {value, map.path.empty() ? name : map.path + "." + name, value != nullptr ? value->place : map.place};
}

std::vector<Node> elements(const Node& list, std::size_t most) {
  if (!list) refuse(list, "is missing");
  if (list.value->kind != Value::Kind::list || list.value->items.empty() || list.value->items.size() > most) {
    refuse(list, fmt::format("{} is not allowed; must be a list of 1 to {}", described(*list.value), most));
  }
  std::vector<Node> out;
  for (std::size_t i = 0; i < list.value->items.size(); ++i) {
    const Value& item = list.value->items[i];
    out.push_back({&item, fmt::format("{}.{}", list.path, i), item.place});
  }
  return out;
}

std::string word(const Node& scalar) {
  if (!scalar) refuse(scalar, "is missing");
  const Value& value = *scalar.value;
  if (value.kind != Value::Kind::scalar || value.text.empty() || value.text.find('\n') != std::string::npos ||
      value.text.size() > 1000) {
    refuse(scalar, fmt::format("{} is not allowed; must be one line of text", described(value)));
  }
  return value.text;
}

double number(const Node& scalar, double low, double high) {
  const auto parsed = scene::parse_number(word(scalar));
  if (!parsed || !std::isfinite(*parsed) || *parsed < low || *parsed > high) {
    refuse(scalar,
           fmt::format("{} is not allowed; must be a number from {:g} to {:g}", described(*scalar.value), low, high));
  }
  return *parsed;
}

long whole(const Node& scalar, long low, long high) {
  const auto parsed = scene::parse_whole(word(scalar));
  if (!parsed || *parsed < low || *parsed > high) {
    refuse(scalar,
           fmt::format("{} is not allowed; must be a whole number from {} to {}", described(*scalar.value), low, high));
  }
  return *parsed;
}

}  // namespace wunderlich::sweep
