#include "wunderlich/scene/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <sstream>
#include <unordered_set>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/text.hpp"

namespace wunderlich::scene {

namespace {

constexpr std::size_t deepest = 20;
constexpr std::size_t most_values = 1'000'000;
// The parser takes what follows an open bracket for a key as well.
constexpr const char* not_a_key = "a key must be one word of at most 1000 bytes; or a bracket or a quote is not closed";

/// Builds the tree from the parser's events, so that nothing is expanded or resolved behind our back.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& source, bool override_source)
      : source_(std::make_shared<const std::string>(source)), override_source_(override_source) {
    root_.place = {source_, 0, 0};
  }

  Value take() { return std::move(root_); }
  Place place(const YAML::Mark& mark) const {
    if (override_source_ || mark.is_null()) return {source_, 0, 0};
    return {source_, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, "", anchor, Value::Kind::null); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(place(mark), "", "aliases (`*name`) are not allowed in scenes; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    if (expects_key()) return add_key(mark, text);
    Value& value = add(mark, tag, anchor, Value::Kind::scalar);
    value.text = text;
    value.quoted = tag == "!";
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, add(mark, tag, anchor, Value::Kind::list));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, add(mark, tag, anchor, Value::Kind::map));
  }
  void OnMapEnd() override { close(); }

 private:
  /// An unfinished list or map; a map's values are one behind its keys while it waits for a value.
  struct Open {
    Value* value;
    std::unordered_set<std::string> seen;
  };

  bool expects_key() const {
    if (open_.empty() || open_.back().value->kind != Value::Kind::map) return false;
    return open_.back().value->names.size() == open_.back().value->items.size();
  }

  void add_key(const YAML::Mark& mark, const std::string& name) {
    Open& top = open_.back();
    if (!top.seen.insert(name).second) fail(place(mark), shown(name), "this key is given twice; keep one of them");
    top.value->names.push_back(name);
    top.value->name_places.push_back(place(mark));
  }

  // Children live in their parent's vector, which grows only while no child of it is open: pointers in `open_` hold.
  Value& add(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, Value::Kind kind) {
    if (expects_key()) fail(place(mark), "", not_a_key);
    if (anchor != 0) fail(place(mark), "", "anchors (`&name`) are not allowed in scenes; write the value out");
    if (!tag.empty() && tag != "?" && tag != "!")
      fail(place(mark), "", fmt::format("the tag `{}` is not allowed", shown(tag)));
    if (++count_ > most_values) fail(place(mark), "", fmt::format("more than {} values", most_values));
    Value& value = open_.empty() ? root_ : open_.back().value->items.emplace_back();
    value.kind = kind;
    value.place = place(mark);
    return value;
  }

  void open(const YAML::Mark& mark, Value& value) {
    if (open_.size() >= deepest) fail(place(mark), "", fmt::format("nested deeper than {} levels", deepest));
    open_.push_back({&value, {}});
  }
  void close() { open_.pop_back(); }

  std::shared_ptr<const std::string> source_;
  bool override_source_;
  Value root_;
  std::vector<Open> open_;
  std::size_t count_ = 0;
};

/// Line and column of a byte, both from 1; columns in bytes.
Place place_of_byte(const std::string& text, std::size_t byte, const std::string& source) {
  Place place{std::make_shared<const std::string>(source), 1, 1};
  for (std::size_t i = 0; i < byte; ++i) {
    ++place.column;
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    }
  }
  return place;
}

std::string escaped(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// Words and numbers stay plain, as a quoted number would be text; the rest, such as a title with a comma, is quoted.
std::string scalar_to_yaml(const Value& value) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 +-*/._";
  const bool simple = value.text.find_first_not_of(plain) == std::string::npos;
  return value.quoted || !simple ? escaped(value.text) : value.text;
}

void write(const Value& value, std::string& out) {
  const bool map = value.kind == Value::Kind::map;
  switch (value.kind) {
    case Value::Kind::null:
      out += "~";
      return;
    case Value::Kind::scalar:
      out += scalar_to_yaml(value);
      return;
    case Value::Kind::list:
    case Value::Kind::map:
      break;
  }
  out += map ? "{" : "[";
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (map) out += escaped(value.names[i]) + ": ";
    write(value.items[i], out);
  }
  out += map ? "}" : "]";
}

}  // namespace

std::string described(const Place& place) {
  if (place.line == 0) return *place.source;
  return fmt::format("{}:{}:{}", *place.source, place.line, place.column);
}

void fail(const Place& place, const std::string& key, const std::string& problem) {
  throw InputError(described(place) + ": " + (key.empty() ? "" : key + ": ") + problem);
}

const Value* Value::find(std::string_view name) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return &items[i];
  }
  return nullptr;
}

Value* Value::find(std::string_view name) { return const_cast<Value*>(std::as_const(*this).find(name)); }

std::string described(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return "no value";
    case Value::Kind::scalar:
      return (value.quoted ? "the text `" : "`") + shown(value.text) + "`";
    case Value::Kind::list:
      return fmt::format("a list of {}", value.items.size());
    case Value::Kind::map:
      break;
  }
  return "a map";
}

Value parse_document(const std::string& text, const std::string& source, bool override_source) {
  if (const auto bad = first_bad_byte(text)) {
    Place place = place_of_byte(text, *bad, source);
    if (override_source) place.line = 0;
    fail(place, "", fmt::format("byte 0x{:02x} is not UTF-8 text", static_cast<unsigned char>(text[*bad])));
  }
  TreeBuilder builder(source, override_source);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return {Value::Kind::null, false, "", {}, {}, {}, builder.place({}), ""};
    Value root = builder.take();
    TreeBuilder second(source, override_source);
    if (parser.HandleNextDocument(second)) fail(second.take().place, "", "a scene is one YAML document, not several");
    return root;
  } catch (const YAML::Exception& e) {
    fail(builder.place(e.mark), "", "not valid YAML: " + e.msg);
  }
}

std::string to_yaml(const Value& root) {
  std::string out;
  for (std::size_t i = 0; i < root.items.size(); ++i) {
    out += escaped(root.names[i]) + ": ";
    write(root.items[i], out);
    out += "\n";
  }
  return out;
}

}  // namespace wunderlich::scene
