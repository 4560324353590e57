/// Runs the reader on a scene that should be refused, and returns what it says.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "wunderlich/base/error.hpp"
#include "wunderlich/scene/read.hpp"

namespace wunderlich::scene {

inline std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_scene_text(text, "bad.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

inline void expect_all(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\nin: " << message;
}

}  // namespace wunderlich::scene
