#include "mjarm/core/os_random.hpp"

namespace mjarm {

bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  volatile unsigned char differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differing = static_cast<unsigned char>(
        differing | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  }
  return differing == 0;
}

}  // namespace mjarm
