/// Values of a sweep file, checked where they are read. Internal to sweep/.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/scene/document.hpp"

namespace wunderlich::sweep {

/// A value with its path in the file, for messages.
struct Node {
  const scene::Value* value = nullptr;  ///< null: absent
  std::string path;
  scene::Place place;  ///< of the value, or of what should hold it
  explicit operator bool() const { return value != nullptr; }
};

[[noreturn]] void refuse(const Node& node, const std::string& problem);

/// Refuses keys of a map that are none of these, and what is no map.
void require_keys(const Node& map, const std::vector<std::string>& allowed);

Node child(const Node& map, const std::string& name);
/// The elements of a list; refuses anything else, and more than `most`.
std::vector<Node> elements(const Node& list, std::size_t most);

/// One line of text without surrounding meaning: a word, a number as it was written.
std::string word(const Node& scalar);
/// A finite number in [low, high], `pi` allowed.
double number(const Node& scalar, double low, double high);
long whole(const Node& scalar, long low, long high);

}  // namespace wunderlich::sweep
