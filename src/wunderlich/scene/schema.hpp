/// The keys of a scene: one table that the reader, its error messages and the documentation share.
#pragma once

#include <string>
#include <vector>

#include "wunderlich/scene/document.hpp"

namespace wunderlich::scene {

enum class Type {
  map,      ///< a map with the keys listed below it
  list,     ///< a list of maps (`path.*`); low and high bound its length
  text,     ///< one line
  lines,    ///< of text
  number,   ///< finite, in [low, high]
  integer,  ///< in [low, high]
  boolean,  ///< true or false
  choice,   ///< one of `choices`
  choices,  ///< a list of some of `choices`
  vector,   ///< three numbers, each in [low, high]
  numbers,  ///< a list of numbers, each in [low, high]
  place,    ///< one of `choices`, or a map with exactly one of the keys below it
};

struct Key {
  std::string path;  ///< `*` stands for a list index
  Type type = Type::map;
  std::string unit;  ///< empty: dimensionless
  double low = 0;
  double high = 0;
  std::string fallback;  ///< as a file would write it; empty: none
  std::vector<std::string> choices;
  std::string doc;  ///< ends in "Required." if its map cannot do without
};

/// Every key, sections before their contents; and those below `obstacles` and `contact`, `solver`, and `compare`.
const std::vector<Key>& keys();
const std::vector<Key>& obstacle_keys();
const std::vector<Key>& solver_keys();
const std::vector<Key>& compare_keys();

/// The key with this pattern, or null.
const Key* find_key(const std::string& pattern);

/// Names of the keys directly below a pattern; those at the top below "".
std::vector<std::string> names_below(const std::string& pattern);

/// Checks every value of the tree against the table: unknown keys, types, ranges, spelling. Throws InputError.
void check_document(const Value& root);

/// What a key accepts, in words: "a number from 0 to 1 m".
std::string allowed(const Key& key);

/// The scene format as a Markdown page: `docs/scene-format.md`.
std::string schema_markdown();

/// The same as a JSON Schema (draft 7) for editors: `docs/scene.schema.json`. It knows the keys, their types, ranges
/// and which are required; what they mean to one another only the reader knows.
std::string schema_json();

/// Where a reader stands in the tree. `value` is null for an absent key.
struct Cell {
  const Value* value = nullptr;
  std::string path;     ///< clamps.0.at
  std::string pattern;  ///< clamps.*.at
  Place place;          ///< of the value, or of the nearest enclosing one
};

Cell root_cell(const Value& root);
Cell child(const Cell& parent, const std::string& name);
Cell element(const Cell& list, std::size_t index);
std::size_t count(const Cell& list);

/// Values of a checked tree, or the table's default where the key is absent. A key without default must be present.
double number(const Cell& cell);
long integer(const Cell& cell);
bool boolean(const Cell& cell);
std::string text(const Cell& cell);
std::vector<std::string> words(const Cell& cell);
std::vector<double> numbers(const Cell& cell);

[[noreturn]] void fail(const Cell& cell, const std::string& problem);

}  // namespace wunderlich::scene
