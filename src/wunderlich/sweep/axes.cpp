#include "wunderlich/sweep/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wunderlich/scene/text.hpp"

namespace wunderlich::sweep {

namespace {

constexpr std::size_t kMostValues = 1'000'000, kMostColumns = 100;
constexpr double kLargest = 1e15;

/// Keys of the scene that one column sets, all to the same value.
std::vector<std::string> keys_of(const Node& entry) {
  const Node one = child(entry, "key"), several = child(entry, "keys");
  if (static_cast<bool>(one) == static_cast<bool>(several)) refuse(entry, "must have `key` or `keys`, and not both");
  if (one) return {word(one)};
  std::vector<std::string> keys;
  for (const Node& key : elements(several, kMostColumns)) keys.push_back(word(key));
  return keys;
}

/// One column: what it is called, the keys it sets, its values as text.
struct Column {
  std::string name;
  std::vector<std::string> keys;
  std::vector<std::string> values;
  bool logarithmic = false;
};

std::string text_of(double value) { return fmt::format("{}", value); }

/// Evenly from one number to another, both ends included; `logarithmic`: by equal factors.
std::vector<std::string> range_of(const Node& range, bool logarithmic) {
  require_keys(range, {"from", "to", "count"});
  const double low = logarithmic ? 1e-300 : -kLargest;
  const double from = number(child(range, "from"), low, kLargest), to = number(child(range, "to"), low, kLargest);
  const long count = whole(child(range, "count"), 1, static_cast<long>(kMostValues));
  std::vector<std::string> values;
  for (long i = 0; i < count; ++i) {
    const double share = count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(count - 1);
    const double inside = logarithmic ? from * std::pow(to / from, share) : from + share * (to - from);
    values.push_back(text_of(i == 0 ? from : i == count - 1 ? to : inside));
  }
  return values;
}

Column column_of(const Node& entry) {
  require_keys(entry, {"key", "keys", "name", "values", "linear", "log"});
  Column column;
  column.keys = keys_of(entry);
  column.name = child(entry, "name") ? word(child(entry, "name")) : column.keys.front();
  const Node values = child(entry, "values"), linear = child(entry, "linear"), log = child(entry, "log");
  if (static_cast<int>(bool(values)) + static_cast<int>(bool(linear)) + static_cast<int>(bool(log)) != 1) {
    refuse(entry, "must have one of `values`, `linear`, `log`");
  }
  if (values) {
    for (const Node& value : elements(values, kMostValues)) column.values.push_back(word(value));
  } else {
    column.logarithmic = bool(log);
    column.values = range_of(linear ? linear : log, column.logarithmic);
  }
  return column;
}

/// Columns beside each other, whose values belong together.
Axis axis_of(const std::vector<Column>& columns) {
  Axis axis;
  axis.logarithmic = columns.front().logarithmic;
  for (const Column& column : columns) axis.columns.push_back(column.name);
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    AxisPoint point;
    for (const Column& column : columns) {
      const std::string& text = column.values[i];
      point.words.push_back(text);
      point.values.push_back(scene::parse_number(text).value_or(std::numeric_limits<double>::quiet_NaN()));
      for (const std::string& key : column.keys) point.assignments.push_back(key + "=" + text);
    }
    axis.points.push_back(std::move(point));
  }
  return axis;
}

Axis zipped(const Node& list) {
  std::vector<Column> columns;
  for (const Node& entry : elements(list, kMostColumns)) {
    columns.push_back(column_of(entry));
    if (columns.back().values.size() == columns.front().values.size()) continue;
    refuse(entry, fmt::format("has {} values, the first of this zip {}; they must be as many",
                              columns.back().values.size(), columns.front().values.size()));
  }
  return axis_of(columns);
}

/// Numbers in [0, 1) for one column: independent, or one in each of `count` equal parts in random order.
std::vector<double> shares(std::size_t count, bool stratified, Random& random) {
  std::vector<double> out(count);
  if (!stratified) {
    for (double& share : out) share = random.uniform();
    return out;
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = (static_cast<double>(order[i]) + random.uniform()) / static_cast<double>(count);
  }
  return out;
}

/// Random or Latin-hypercube samples of several ranges at once.   @eq McKay1979
Axis sampled(const Node& entry, bool stratified) {
  require_keys(entry, {"count", "seed", "axes"});
  const auto count = static_cast<std::size_t>(whole(child(entry, "count"), 1, static_cast<long>(kMostValues)));
  Random random(static_cast<std::uint64_t>(whole(child(entry, "seed"), 0, std::numeric_limits<long>::max())));
  std::vector<Column> columns;
  for (const Node& item : elements(child(entry, "axes"), kMostColumns)) {
    require_keys(item, {"key", "keys", "name", "from", "to", "scale"});
    Column column;
    column.keys = keys_of(item);
    column.name = child(item, "name") ? word(child(item, "name")) : column.keys.front();
    const std::string scale = child(item, "scale") ? word(child(item, "scale")) : "linear";
    if (scale != "linear" && scale != "log") refuse(child(item, "scale"), "must be `linear` or `log`");
    const bool logarithmic = scale == "log";
    const double low = logarithmic ? 1e-300 : -kLargest;
    const double from = number(child(item, "from"), low, kLargest), to = number(child(item, "to"), low, kLargest);
    for (const double share : shares(count, stratified, random)) {
      column.values.push_back(text_of(logarithmic ? from * std::pow(to / from, share) : from + share * (to - from)));
    }
    column.logarithmic = logarithmic;
    columns.push_back(std::move(column));
  }
  return axis_of(columns);
}

}  // namespace

Axis read_axis(const Node& entry) {
  for (const char* kind : {"zip", "random", "latin_hypercube"}) {
    const Node inner = child(entry, kind);
    if (!inner) continue;
    require_keys(entry, {kind});
    return kind == std::string("zip") ? zipped(inner) : sampled(inner, kind == std::string("latin_hypercube"));
  }
  if (entry.value->kind == scene::Value::Kind::map && !entry.value->find("key") && !entry.value->find("keys")) {
    require_keys(entry, {"key", "keys", "name", "values", "linear", "log", "zip", "random", "latin_hypercube"});
  }
  return axis_of({column_of(entry)});
}

std::uint64_t Random::next() {  // splitmix64   @eq Steele2014
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

std::size_t Random::below(std::size_t n) { return static_cast<std::size_t>(uniform() * static_cast<double>(n)); }

}  // namespace wunderlich::sweep
