/// A scene file as a tree whose every value knows where it was written.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace wunderlich::scene {

/// Where a value was written. Line 0 means the whole source: an override given on the command line.
struct Place {
  std::shared_ptr<const std::string> source;  ///< file name, or `--set key=value`
  int line = 0;
  int column = 0;
};

/// `source:line:column`
std::string described(const Place& place);

/// Throws InputError: `place: key: problem`.
[[noreturn]] void fail(const Place& place, const std::string& key, const std::string& problem);

/// A YAML value. Anchors, aliases and tags do not occur: the parser refuses them.
struct Value {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  bool quoted = false;             ///< scalars: written in quotes or as a block, hence text
  std::string text;                ///< scalars
  std::vector<Value> items;        ///< list elements, or map values
  std::vector<std::string> names;  ///< map keys, parallel to `items`; unique
  std::vector<Place> name_places;  ///< parallel to `names`
  Place place;
  std::string alias;  ///< where the document has it, if it is read from elsewhere: `ribbons.1.clamps`

  /// The value of a map key, or null.
  const Value* find(std::string_view name) const;
  Value* find(std::string_view name);
};

/// What a value is, for messages: "`abc`", "a list of 3".
std::string described(const Value& value);

/// Parses one YAML document. `override_source` marks a value that came from the command line, which has no lines.
/// Throws InputError on malformed text, duplicate keys, more than one document, anchors, tags, nesting deeper than
/// 20 levels and more than a million values.
Value parse_document(const std::string& text, const std::string& source, bool override_source = false);

/// Applies `key.path=value`; list elements by index, the index after the last one appends. Missing maps and lists
/// on the way are created. `null` takes the key, or the list's element, away.
void apply_override(Value& root, const std::string& assignment);

/// The tree as YAML that parses to the same tree; scalars keep their spelling.
std::string to_yaml(const Value& root);

}  // namespace wunderlich::scene
