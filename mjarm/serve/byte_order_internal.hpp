#pragma once

#include <bit>
#include <cstdint>
#include <string>

/// Numbers as bytes, little endian on every machine.
namespace mjarm::serve {

template <class Whole>
void append_whole(std::string& out, Whole value) {
  for (std::size_t i = 0; i < sizeof(Whole); ++i) {
    out += static_cast<char>((value >> (8 * i)) & 0xFF);
  }
}
inline void append_f32(std::string& out, float value) {
  append_whole(out, std::bit_cast<std::uint32_t>(value));
}
inline void append_f64(std::string& out, double value) {
  append_whole(out, std::bit_cast<std::uint64_t>(value));
}

}  // namespace mjarm::serve
