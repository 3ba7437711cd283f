#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace mjarm {

/// An unsigned number of `bytes` bytes.
template <std::size_t bytes>
struct BitsOfSize;
template <>
struct BitsOfSize<1> : std::type_identity<std::uint8_t> {};
template <>
struct BitsOfSize<2> : std::type_identity<std::uint16_t> {};
template <>
struct BitsOfSize<4> : std::type_identity<std::uint32_t> {};
template <>
struct BitsOfSize<8> : std::type_identity<std::uint64_t> {};
template <class Number>
using BitsOf = typename BitsOfSize<sizeof(Number)>::type;

/// The little-endian number at `bytes[at]`, on machines of any byte order; all of it must be there.
template <class Number>
[[nodiscard]] Number load_little(std::string_view bytes, std::size_t at = 0) {
  BitsOf<Number> bits = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    bits = static_cast<BitsOf<Number>>(bits << 8 | static_cast<unsigned char>(bytes[at + i]));
  }
  return std::bit_cast<Number>(bits);
}

/// Appends `value` in little-endian order.
template <class Number>
void append_little(std::string& out, Number value) {
  auto bits = std::bit_cast<BitsOf<Number>>(value);
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    out += static_cast<char>(bits & 0xFF);
    bits = static_cast<BitsOf<Number>>(bits >> 8);
  }
}

}  // namespace mjarm
