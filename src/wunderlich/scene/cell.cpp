#include <fmt/format.h>

#include <cassert>

#include "wunderlich/scene/schema.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

/// The table's default as a value; fails where the key must be given.
Value fallback(const Cell& cell) {
  const Key* key = find_key(cell.pattern);
  assert(key != nullptr);
  if (key->fallback.empty()) fail(cell, fmt::format("is missing; give {}", allowed(*key)));
  return parse_document(key->fallback, "default");
}

/// Calls `read` on the value of a cell or on its default.
template <typename Read>
auto read_value(const Cell& cell, Read read) {
  return cell.value != nullptr ? read(*cell.value) : read(fallback(cell));
}

}  // namespace

Cell root_cell(const Value& root) { return {&root, "", "", root.place}; }

Cell child(const Cell& parent, const std::string& name) {
  const std::string dot = parent.path.empty() ? "" : ".";
  const Value* value = parent.value == nullptr ? nullptr : parent.value->find(name);
  const bool elsewhere = value != nullptr && !value->alias.empty();
  return {value, elsewhere ? value->alias : parent.path + dot + name, parent.pattern + dot + name,
          value != nullptr ? value->place : parent.place};
}

Cell element(const Cell& list, std::size_t index) {
  const Value& value = list.value->items[index];
  return {&value, fmt::format("{}.{}", list.path, index), list.pattern + ".*", value.place};
}

std::size_t count(const Cell& list) { return list.value == nullptr ? 0 : list.value->items.size(); }

double number(const Cell& cell) {
  return read_value(cell, [](const Value& value) { return *parse_number(value.text); });
}

long integer(const Cell& cell) {
  return read_value(cell, [](const Value& value) { return *parse_whole(value.text); });
}

bool boolean(const Cell& cell) {
  return read_value(cell, [](const Value& value) { return value.text == "true"; });
}

std::string text(const Cell& cell) {
  return read_value(cell, [](const Value& value) { return value.text; });
}

std::vector<std::string> words(const Cell& cell) {
  return read_value(cell, [](const Value& value) {
    std::vector<std::string> list;
    for (const Value& item : value.items) list.push_back(item.text);
    return list;
  });
}

std::vector<double> numbers(const Cell& cell) {
  return read_value(cell, [](const Value& value) {
    std::vector<double> list;
    for (const Value& item : value.items) list.push_back(*parse_number(item.text));
    return list;
  });
}

void fail(const Cell& cell, const std::string& problem) { fail(cell.place, cell.path, problem); }

}  // namespace wunderlich::scene
