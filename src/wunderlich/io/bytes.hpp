/// Little-endian bytes for the binary formats.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "wunderlich/base/types.hpp"

namespace wunderlich::io {

static_assert(std::endian::native == std::endian::little, "the binary formats are written as the machine holds them");

template <class T>
void append(std::string& out, T value) {
  static_assert(std::is_arithmetic_v<T>);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline void append_float3(std::string& out, const Vec3& v) {
  for (int k = 0; k < 3; ++k) append(out, static_cast<float>(v[k]));
}

/// Base64 with padding (RFC 4648).
std::string base64(std::string_view bytes);

/// 64-bit FNV-1a: finds damage, not malice.
std::uint64_t checksum(std::string_view bytes);

}  // namespace wunderlich::io
