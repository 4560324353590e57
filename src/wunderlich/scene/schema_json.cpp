#include <fmt/format.h>

#include <utility>

#include "wunderlich/scene/schema.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

/// Names with values that are JSON already.
using Members = std::vector<std::pair<std::string, std::string>>;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string object(const Members& members) {
  std::string out;
  for (const auto& [name, value] : members) {
    out += (out.empty() ? "\n  " : ",\n  ") + quoted(name) + ": ";
    for (const char c : value) out += c == '\n' ? "\n  " : std::string(1, c);
  }
  return "{" + out + "\n}";
}

std::string array(const std::vector<std::string>& values) { return fmt::format("[{}]", joined(values)); }

std::string words(const std::vector<std::string>& texts) {
  std::vector<std::string> list;
  for (const std::string& text : texts) list.push_back(quoted(text));
  return array(list);
}

std::string count_of(double number) { return fmt::format("{:.0f}", number); }

/// `#/$defs/product`: what `parse_number` reads beside decimal numbers, and those that readers of YAML 1.1 take for
/// text
/// (`1e-3`). A range cannot be asked of it.
std::string product() {
  const std::string factor = R"((pi|([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?))";
  return object({{"type", quoted("string")},
                 {"pattern", quoted("^[-+]?" + factor + "( *[*/] *" + factor + "| *pi)* *$")},
                 {"description", quoted("A product or quotient of numbers and pi: pi/2, 5*pi/4, 1/3")}});
}

std::string number_in(double low, double high) {
  const std::string decimal = object(
      {{"type", quoted("number")}, {"minimum", fmt::format("{:g}", low)}, {"maximum", fmt::format("{:g}", high)}});
  return array({decimal, object({{"$ref", quoted("#/$defs/product")}})});
}

std::string schema_of(const Key& key);

/// The keys of a map.
Members members_of(const std::string& pattern) {
  Members properties;
  std::vector<std::string> required;
  for (const std::string& name : names_below(pattern)) {
    const Key& key = *find_key(pattern.empty() ? name : pattern + "." + name);
    properties.emplace_back(name, schema_of(key));
    const std::string mark = "Required.";
    const std::string& doc = key.doc;
    if (doc.size() >= mark.size() && doc.substr(doc.size() - mark.size()) == mark) required.push_back(name);
  }
  Members members{{"type", quoted("object")}, {"additionalProperties", "false"}, {"properties", object(properties)}};
  if (!required.empty()) members.emplace_back("required", words(required));
  return members;
}

std::string one_of_the_keys(const Key& key) {
  Members map = members_of(key.path);
  map.emplace_back("minProperties", "1");
  map.emplace_back("maxProperties", "1");
  return array({object({{"enum", words(key.choices)}}), object(map)});
}

/// What a value of the key's type is.
Members members_of(const Key& key) {
  switch (key.type) {
    case Type::map:
      return members_of(key.path);
    case Type::list:
      return {{"type", quoted("array")},
              {"minItems", count_of(key.low)},
              {"maxItems", count_of(key.high)},
              {"items", object(members_of(key.path + ".*"))}};
    case Type::text:  // a scalar that needs no quotes: `title: 5`
      return {{"type", words({"string", "number", "boolean"})}, {"maxLength", "200"}, {"pattern", quoted("^[^\\n]*$")}};
    case Type::lines:
      return {{"type", quoted("string")}, {"minLength", "1"}};
    case Type::number:
      return {{"anyOf", number_in(key.low, key.high)}};
    case Type::integer:
      return {{"type", quoted("integer")}, {"minimum", count_of(key.low)}, {"maximum", count_of(key.high)}};
    case Type::boolean:
      return {{"type", quoted("boolean")}};
    case Type::choice:
      return {{"enum", words(key.choices)}};
    case Type::choices:
      return {{"type", quoted("array")},
              {"maxItems", count_of(key.high)},
              {"items", object({{"enum", words(key.choices)}})}};
    case Type::vector:
      return {{"type", quoted("array")},
              {"minItems", "3"},
              {"maxItems", "3"},
              {"items", object({{"anyOf", number_in(key.low, key.high)}})}};
    case Type::numbers:
      return {{"type", quoted("array")}, {"items", object({{"anyOf", number_in(key.low, key.high)}})}};
    case Type::place:
      break;
  }
  return {{"anyOf", one_of_the_keys(key)}};
}

std::string schema_of(const Key& key) {
  Members members{{"description", quoted(key.unit.empty() ? key.doc : key.doc + " [" + key.unit + "]")}};
  for (auto& member : members_of(key)) members.push_back(std::move(member));
  return object(members);
}

}  // namespace

std::string schema_json() {
  Members members{
      {"$schema", quoted("http://json-schema.org/draft-07/schema#")},
      {"title", quoted("A scene of Wunderlich")},
      {"$comment", quoted("Generated by `wunderlich schema --json`; do not edit. The table of keys is "
                          "src/wunderlich/scene/keys.cpp.")},
      {"$defs", object({{"product", product()}})},
      {"oneOf", array({object({{"required", words({"ribbon"})}}), object({{"required", words({"ribbons"})}})})}};
  for (auto& member : members_of(std::string())) members.push_back(std::move(member));
  return object(members) + "\n";
}

}  // namespace wunderlich::scene
