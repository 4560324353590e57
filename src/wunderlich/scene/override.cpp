#include <fmt/format.h>

#include <algorithm>
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

/// The index of a part that is there, or the number of items.
std::size_t find_item(const Value& holder, const std::string& part) {
  const std::size_t count = holder.items.size();
  if (holder.kind == Value::Kind::map) {
    return static_cast<std::size_t>(std::find(holder.names.begin(), holder.names.end(), part) - holder.names.begin());
  }
  const auto index = is_index(part) ? parse_whole(part) : std::nullopt;
  return index && *index < static_cast<long>(count) ? static_cast<std::size_t>(*index) : count;
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
  const std::size_t i = find_item(map, part);
  if (i < map.items.size()) {
    map.name_places[i] = place;
    return map.items[i];
  }
  map.names.push_back(part);
  map.name_places.push_back(place);
  map.items.emplace_back().place = place;
  return map.items.back();
}

void erase_item(Value& holder, std::size_t index) {
  const auto at = static_cast<std::ptrdiff_t>(index);
  if (holder.kind == Value::Kind::map) {
    holder.names.erase(holder.names.begin() + at);
    holder.name_places.erase(holder.name_places.begin() + at);
  }
  holder.items.erase(holder.items.begin() + at);
}

/// Takes a key or a list's element away. Throws InputError where there is none.
void take_away(Value& root, const std::vector<std::string>& parts, const Place& place, const std::string& path) {
  Value* holder = &root;
  for (std::size_t i = 0;; ++i) {
    const std::size_t index = find_item(*holder, parts[i]);
    if (index == holder->items.size()) fail(place, path, "is not in the scene, so that null takes nothing away");
    if (i + 1 == parts.size()) return erase_item(*holder, index);
    holder = &holder->items[index];
  }
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
      return erase_item(*ribbon, i);
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
  for (const std::string& part : parts) {
    if (part.empty()) fail(place, shown(path), "has an empty part; keys look like ribbon.width or clamps.0.turn");
  }
  const std::string text = assignment.substr(equals + 1);
  Value value = parse_document(text, source, true);
  if (value.kind == Value::Kind::null) {
    if (text.find_first_not_of(" \t") == std::string::npos) fail(place, shown(path), "has no value");
    return take_away(root, parts, place, shown(path));
  }
  Value* target = &root;
  for (const std::string& part : parts) {
    target = &descend(*target, part, place, shown(path));
  }
  *target = std::move(value);
  drop_alternative(root, path);
}

}  // namespace wunderlich::scene
