#include "wunderlich/sweep/record.hpp"

#include <fmt/format.h>

#include <array>
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
  Json head = {{"key", record.key}, {"status", status_name(record.status)}};
  if (!record.reason.empty()) head["reason"] = record.reason;
  if (!record.body.empty()) head["body"] = Json::parse(record.body);
  const std::string text = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  return fmt::format("{:016x} {}\n", io::checksum(text), text);
}

std::optional<Record> parse_line(std::string_view line) {
  if (line.size() < kDigits + 3 || line[kDigits] != ' ') return {};
  const std::string_view text = line.substr(kDigits + 1);
  if (fmt::format("{:016x}", io::checksum(text)) != line.substr(0, kDigits)) return {};
  const Json head = Json::parse(text, nullptr, false);
  if (!head.is_object()) return {};
  Record record;
  record.key = head.value("key", "");
  record.reason = head.value("reason", "");
  const std::string status = head.value("status", "");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (status == names[i]) record.status = static_cast<Status>(i);
  }
  if (head.contains("body")) record.body = head["body"].dump();
  return record;
}

}  // namespace wunderlich::sweep
