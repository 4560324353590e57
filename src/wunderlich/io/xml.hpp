/// Text inside XML.
#pragma once

#include <string>
#include <string_view>

namespace wunderlich::io {

/// For element content and for attributes in double quotes; control characters, which XML has none of, are left out.
inline std::string escaped_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

}  // namespace wunderlich::io
