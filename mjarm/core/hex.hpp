#pragma once

#include <string>
#include <string_view>

namespace mjarm {

/// Appends a byte as two lower-case hexadecimal digits.
inline void append_hex(std::string& out, unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  out += kDigits[byte >> 4U];
  out += kDigits[byte & 15U];
}

/// The digits of all bytes, one after the other.
[[nodiscard]] inline std::string hex(std::string_view bytes) {
  std::string out;
  for (const char byte : bytes) append_hex(out, static_cast<unsigned char>(byte));
  return out;
}

}  // namespace mjarm
