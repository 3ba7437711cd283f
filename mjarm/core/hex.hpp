#pragma once

#include <span>
#include <string>

namespace mjarm {

/// Appends a byte as two lower-case hexadecimal digits.
inline void append_hex(std::string& out, unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  out += kDigits[byte >> 4U];
  out += kDigits[byte & 15U];
}

/// The digits of all bytes, one after the other.
[[nodiscard]] inline std::string hex(std::span<const unsigned char> bytes) {
  std::string out;
  for (const unsigned char byte : bytes) append_hex(out, byte);
  return out;
}

}  // namespace mjarm
