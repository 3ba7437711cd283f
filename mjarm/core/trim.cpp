#include "mjarm/core/trim.hpp"

namespace mjarm {

std::string_view trimmed(std::string_view words, std::string_view blanks) noexcept {
  const std::size_t first = words.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return words.substr(first, words.find_last_not_of(blanks) - first + 1);
}

}  // namespace mjarm
