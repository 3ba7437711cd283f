#include <cstdint>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/episode/npy_internal.hpp"

namespace mjarm::episode {

std::string npy(std::span<const double> values, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kMagic = 10;  // bytes before the header: magic, version, length
  constexpr std::size_t kAlign = 64;
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  for (const std::size_t size : shape) header += std::to_string(size) + ",";
  header += "), }";
  header.append(kAlign - (kMagic + header.size() + 1) % kAlign, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  append_little(out, static_cast<std::uint16_t>(header.size()));
  out += header;
  out.reserve(out.size() + 8 * values.size());
  for (const double value : values) append_little(out, value);
  return out;
}

}  // namespace mjarm::episode
