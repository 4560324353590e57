/// Any bytes as a scene file: the reader returns a scene or throws InputError, nothing else. What it accepts must
/// read back from its own resolved text to the same resolved text. Everything after a line `--set` is an override.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/read.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using wunderlich::scene::read_scene_text;
  std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> overrides;
  const std::string marker = "\n--set ";
  for (std::size_t at = text.rfind(marker); at != std::string::npos; at = text.rfind(marker)) {
    overrides.insert(overrides.begin(), text.substr(at + marker.size()));
    text.resize(at);
  }
  std::string resolved;
  try {
    resolved = read_scene_text(text, "fuzz.yaml", overrides).resolved;
  } catch (const wunderlich::InputError&) {
    return 0;
  }
  if (read_scene_text(resolved, "resolved.yaml").resolved != resolved) std::abort();
  return 0;
}
