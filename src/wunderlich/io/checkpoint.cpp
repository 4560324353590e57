#include "wunderlich/io/checkpoint.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "wunderlich/base/error.hpp"
#include "wunderlich/io/bytes.hpp"
#include "wunderlich/io/file.hpp"

namespace wunderlich::io {

namespace {

using nlohmann::json;

/// Not text, and broken by any transfer that changes line ends.
constexpr std::string_view magic("\x89WNDR\r\n\x1a", 8);
constexpr std::size_t header_size = 8 + 4 + 8 + 8;  // magic, version, payload length, checksum

[[noreturn]] void refuse(std::string_view origin, std::string_view problem) {
  throw InputError(
      fmt::format("{}: {}; a checkpoint written by this version of wunderlich is needed", origin, problem));
}

template <class T>
T load(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::vector<std::uint8_t> raw(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(double));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

Checkpoint from_json(const json& root, std::string_view origin) {
  Checkpoint out;
  const bool shaped = root.is_object() && root.contains("texts") && root["texts"].is_object() &&
                      root.contains("arrays") && root["arrays"].is_object();
  if (!shaped) refuse(origin, "not a checkpoint inside");
  for (const auto& [key, value] : root["texts"].items()) {
    if (!value.is_string()) refuse(origin, fmt::format("'{}' is not a text", key));
    out.texts[key] = value.get<std::string>();
  }
  for (const auto& [key, value] : root["arrays"].items()) {
    if (!value.is_binary() || value.get_binary().size() % sizeof(double) != 0) {
      refuse(origin, fmt::format("'{}' is not an array of numbers", key));
    }
    const auto& bytes = value.get_binary();
    std::vector<double>& array = out.arrays[key];
    array.resize(bytes.size() / sizeof(double));
    if (!bytes.empty()) std::memcpy(array.data(), bytes.data(), bytes.size());
  }
  return out;
}

}  // namespace

std::string encode_checkpoint(const Checkpoint& checkpoint) {
  json root = {{"texts", json::object()}, {"arrays", json::object()}};
  for (const auto& [key, text] : checkpoint.texts) root["texts"][key] = text;
  for (const auto& [key, array] : checkpoint.arrays) root["arrays"][key] = json::binary(raw(array));
  std::string payload;
  json::to_cbor(root, payload);
  std::string out(magic);
  append(out, static_cast<std::int32_t>(checkpoint.version));
  append(out, static_cast<std::uint64_t>(payload.size()));
  append(out, checksum(payload));
  return out + payload;
}

Checkpoint decode_checkpoint(std::string_view bytes, std::string_view origin) {
  if (bytes.substr(0, magic.size()) != magic) refuse(origin, "not a checkpoint");
  if (bytes.size() < header_size) refuse(origin, "cut short");
  const auto version = load<std::int32_t>(bytes, 8);
  if (version != Checkpoint::current_version) refuse(origin, fmt::format("format version {} is unknown", version));
  const std::string_view payload = bytes.substr(header_size);
  if (load<std::uint64_t>(bytes, 12) != payload.size()) refuse(origin, "cut short or extended");
  if (load<std::uint64_t>(bytes, 20) != checksum(payload)) refuse(origin, "damaged (checksum mismatch)");
  json root;
  try {
    root = json::from_cbor(payload);
  } catch (const json::exception& error) {
    refuse(origin, fmt::format("damaged ({})", error.what()));
  }
  return from_json(root, origin);
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  write_file(path, encode_checkpoint(checkpoint));
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  return decode_checkpoint(read_file(path), path.string());
}

}  // namespace wunderlich::io
