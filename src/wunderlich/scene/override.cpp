#include <fmt/format.h>

#include <array>

#include "wunderlich/scene/document.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

constexpr std::size_t longest_path = 20;

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

bool is_index(const std::string& part) {
  return !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
}

Value& list_item(Value& list, const std::string& part, const Place& place, const std::string& path) {
  const auto index = parse_whole(part);
  const std::size_t size = list.items.size();
  if (!is_index(part) || !index || *index > static_cast<long>(size)) {
    fail(place, path,
         fmt::format("`{}` is no element of this list; allowed: 0 to {}, where {} appends", shown(part), size, size));
  }
  if (*index == static_cast<long>(size)) list.items.emplace_back().place = place;
  return list.items[static_cast<std::size_t>(*index)];
}

Value& map_item(Value& map, const std::string& part, const Place& place) {
  for (std::size_t i = 0; i < map.names.size(); ++i) {
    if (map.names[i] != part) continue;
    map.name_places[i] = place;
    return map.items[i];
  }
  map.names.push_back(part);
  map.name_places.push_back(place);
  map.items.emplace_back().place = place;
  return map.items.back();
}

/// One step down the tree; an absent value becomes the map or list that the step needs.
Value& descend(Value& value, const std::string& part, const Place& place, const std::string& path) {
  if (value.kind == Value::Kind::null) value.kind = is_index(part) ? Value::Kind::list : Value::Kind::map;
  if (value.kind == Value::Kind::list) return list_item(value, part, place, path);
  if (value.kind == Value::Kind::map) return map_item(value, part, place);
  fail(place, path,
       fmt::format("stands below {}, which is neither a map nor a list; override that as a whole", described(value)));
}

/// Keys that say the same thing in two ways: setting one takes the other away.
void drop_alternative(Value& root, const std::string& path) {
  constexpr std::array<std::array<const char*, 2>, 2> alternatives{{{"width", "aspect"}, {"aspect", "width"}}};
  Value* ribbon = root.find("ribbon");
  if (ribbon == nullptr) return;
  for (const auto& [given, other] : alternatives) {
    if (path != std::string("ribbon.") + given) continue;
    for (std::size_t i = 0; i < ribbon->names.size(); ++i) {
      // What another override set stays: two overrides that contradict each other are an error of the user's.
      if (ribbon->names[i] != other || ribbon->name_places[i].line == 0) continue;
      const auto at = static_cast<std::ptrdiff_t>(i);
      ribbon->names.erase(ribbon->names.begin() + at);
      ribbon->name_places.erase(ribbon->name_places.begin() + at);
      ribbon->items.erase(ribbon->items.begin() + at);
      return;
    }
  }
}

}  // namespace

void apply_override(Value& root, const std::string& assignment) {
  const std::string source = "--set " + shown(assignment, 100);
  const Place place{std::make_shared<const std::string>(source), 0, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) fail(place, "", "must be key=value, such as ribbon.segments=200");
  const std::string path = assignment.substr(0, equals);
  if (first_bad_byte(path)) fail(place, "", "the key is not UTF-8 text");
  const std::vector<std::string> parts = split(path);
  if (parts.size() > longest_path) fail(place, "", "the key has too many parts");
  Value value = parse_document(assignment.substr(equals + 1), source, true);
  if (value.kind == Value::Kind::null) fail(place, shown(path), "has no value");
  Value* target = &root;
  for (const std::string& part : parts) {
    if (part.empty()) fail(place, shown(path), "has an empty part; keys look like ribbon.width or clamps.0.turn");
    target = &descend(*target, part, place, shown(path));
  }
  *target = std::move(value);
  drop_alternative(root, path);
}

}  // namespace wunderlich::scene
