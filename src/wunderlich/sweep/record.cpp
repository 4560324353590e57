#include "wunderlich/sweep/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "wunderlich/io/bytes.hpp"

namespace wunderlich::sweep {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 5> names{"done", "not-converged", "refused", "failed", "timed-out"};
constexpr std::size_t kDigits = 16;  // of a checksum

}  // namespace

const char* status_name(Status status) { return names[static_cast<std::size_t>(status)]; }

std::string line_of(const Record& record) {
  const std::string reason = Json(record.reason).dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string text =
      fmt::format("{}\t{}\t{}\t{}\t{}", record.key, status_name(record.status), record.seconds, reason, record.body);
  return fmt::format("{:016x}\t{}\n", io::checksum(text), text);
}

std::optional<Record> parse_line(std::string_view line) {
  if (line.size() < kDigits + 1 || line[kDigits] != '\t') return {};
  std::string_view text = line.substr(kDigits + 1);
  if (fmt::format("{:016x}", io::checksum(text)) != line.substr(0, kDigits)) return {};
  std::array<std::string_view, 5> field;
  for (std::string_view& part : field) {
    const std::size_t end = std::min(text.find('\t'), text.size());
    part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  Record record;
  record.key = field[0];
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (field[1] == names[i]) record.status = static_cast<Status>(i);
  }
  record.seconds = std::strtod(std::string(field[2]).c_str(), nullptr);
  const Json reason = Json::parse(field[3], nullptr, false);
  if (reason.is_string()) record.reason = reason.get<std::string>();
  record.body = field[4];
  return record;
}

}  // namespace wunderlich::sweep
