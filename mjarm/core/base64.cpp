#include "mjarm/core/base64.hpp"

#include <cstdint>

namespace mjarm {

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(4 * ((bytes.size() + 2) / 3));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      three = (three << 8) | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool beyond = i + k > bytes.size();  // k digits hold less than k bytes
      out += beyond ? '=' : kDigits[(three >> (18 - 6 * k)) & 63U];
    }
  }
  return out;
}

}  // namespace mjarm
